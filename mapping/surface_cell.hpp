#pragma once

#include <cstdint>

#include "mapping/cell_key.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// One temperature measured on a surface.
struct TemperatureObservation {
  float celsius = 0.0F;
  float sigma = 0.0F;      ///< one standard deviation, C; the camera's common bias is not in it
  float range = 0.0F;      ///< camera to point, metres
  float incidence = 0.0F;  ///< angle between the line of sight and the surface's normal, radians; NaN unknown
};

/// What a cell knows of the surface in it. All sums are integers in fixed point, so that adding is exact and
/// the result does not depend on the order (West's and Chan's updates would, in the last bits).
/// observations == 0 is the ONLY test for "no temperature": 0 C is one.
struct SurfaceCell {
  /// Sum over the returns of their place within the cell, in 1/256 of the cell's edge.
  std::uint32_t offset_sum[3] = {0, 0, 0};
  std::uint32_t returns = 0;       ///< laser returns that hit the cell; sums stop at kMaxReturns
  std::uint32_t observations = 0;  ///< temperatures
  float min_celsius = 0.0F;
  float max_celsius = 0.0F;
  float best_range = 0.0F;      ///< camera to point at the view with the smallest sigma, metres
  float best_incidence = 0.0F;  ///< of that view, radians; NaN unknown
  float best_sigma = 0.0F;      ///< of that view, C
  std::int64_t first_ns = 0;    ///< stamp of the first temperature
  std::int64_t last_ns = 0;     ///< and of the last
  std::uint64_t weight_sum = 0;            ///< of 1 / sigma^2, in units of kWeightUnit
  std::int64_t weighted_sum = 0;           ///< weight x temperature, in kWeightUnit x kTemperatureUnit
  unsigned __int128 weighted_square_sum = 0;  ///< weight x temperature^2
};

}  // namespace thermovox
