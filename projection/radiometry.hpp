#pragma once

#include <cmath>
#include <limits>

namespace thermovox {

/// 0 K in Celsius.
inline constexpr double kAbsoluteZero = -273.15;

/// Linear camera: Celsius = counts * celsius_per_count + celsius_offset. A FLIR Duo R stores hundredths of a
/// kelvin: 31730 counts are 44.15 C.
struct TLinear {
  double celsius_per_count = 0.01;
  double celsius_offset = kAbsoluteZero;

  /// Celsius of a count; NaN for what no surface can have (absolute zero and below, as an empty pixel of
  /// count 0 would read).
  [[nodiscard]] float celsius(double counts) const {
    const double value = counts * celsius_per_count + celsius_offset;
    return value > kAbsoluteZero + 1e-6 ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
  }
};

}  // namespace thermovox
