#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermovox {

/// The value below which a share of the values lies, linear between two of them. Precondition: not empty.
[[nodiscard]] inline double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double above = values[std::min(below + 1, values.size() - 1)];
  return values[below] + (place - std::floor(place)) * (above - values[below]);
}

}  // namespace thermovox
