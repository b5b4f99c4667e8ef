#pragma once

#include <optional>
#include <span>
#include <string>

#include "mapping/hotspot.hpp"

namespace thermovox {

/// What a mission says of a hot spot.
struct TrendPoint {
  std::string label;              ///< below the axis
  std::optional<Estimate> delta;  ///< over the surroundings, C; none where nobody looked
  bool hot = true;                ///< found as a hot spot; false: looked at and found cool
};

/// SVG of the rises over the surroundings by mission: points with bars of 95 %, filled where a hot spot was
/// found, joined by a line that has gaps where the spot was not observed.
[[nodiscard]] std::string trendPlot(std::span<const TrendPoint> points, const std::string& label);

}  // namespace thermovox
