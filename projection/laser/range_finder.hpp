#pragma once

#include "projection/laser/laser_return.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// One range of a single-beam laser (LIDAR-Lite and kin).
struct BeamReading {
  Time stamp;
  double range = 0.0;  ///< metres
  float intensity = std::numeric_limits<float>::quiet_NaN();
};

/// A 1D laser measures along +x of its frame: p_laser = (range, 0, 0).
[[nodiscard]] Reading readingFromBeam(const BeamReading& beam, const Laser& laser);

}  // namespace thermovox
