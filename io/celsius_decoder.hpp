#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "io/raw_thermal_image.hpp"
#include "projection/celsius_table.hpp"
#include "projection/radiometric_overrides.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// Turns stored images into temperatures, by a table that lasts as long as the parameters stay the same.
class CelsiusDecoder {
 public:
  /// `name` stands for the image in messages. Throws DataError when its counts are no temperatures, or when
  /// there are overrides and its temperatures are of the camera's own making; ConfigError naming a parameter
  /// that cannot be.
  [[nodiscard]] ThermalImage decode(const RawThermalImage& image, const std::string& name,
                                    const RadiometricOverrides& overrides = {});

 private:
  std::optional<CelsiusTable> table_;
};

/// The temperatures of an image at a glance.
struct ThermalStatistics {
  std::optional<double> min, mean, max;  ///< C, of the known pixels; empty when there are none
  std::size_t unknown = 0;               ///< pixels without a temperature
  std::size_t below_range = 0;           ///< pixels colder than the camera is calibrated for
  std::size_t above_range = 0;
};

[[nodiscard]] ThermalStatistics statisticsOf(const ThermalImage& image,
                                             const std::optional<CalibratedRange>& range);

}  // namespace thermovox
