#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "projection/air_path.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// Temperatures that a camera is calibrated for, C.
struct CalibratedRange {
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] bool isBelow(double celsius) const { return celsius < low; }
  [[nodiscard]] bool isAbove(double celsius) const { return celsius > high; }
};

/// Temperatures of a thermal camera, row by row, Celsius; NaN is "not known".
struct ThermalImage {
  int width = 0;
  int height = 0;
  std::vector<float> celsius;
  /// The air before the camera, of an image whose temperatures are those at distance 0 (a radiometric frame
  /// of a mission): what a point's own distance makes of them. Null where the temperatures stand as they are.
  std::shared_ptr<const AirPath> air;
  /// How many times the camera's noise its temperatures have: 1 / (emissivity * window), by which the
  /// object's radiation was raised to that of a black body. What the air adds is the slope of `air`.
  float noise_gain = 1.0F;
  /// What lies outside is kept as it is, and is to be marked or counted; empty where it is not known.
  std::optional<CalibratedRange> calibrated_range;

  [[nodiscard]] float at(int u, int v) const {
    return celsius[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(u)];
  }
};

/// One frame of the thermal camera. `stamp` is on the mission's clock: the camera's time offset is in it.
struct ThermalFrame {
  Time stamp;
  std::shared_ptr<const ThermalImage> image;
  std::string name;  ///< where it came from, for messages and reports
};

}  // namespace thermovox
