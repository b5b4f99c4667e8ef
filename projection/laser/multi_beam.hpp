#pragma once

#include <span>

#include "projection/laser/laser_return.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// A point of a 3D laser's cloud, laser frame.
struct CloudPoint {
  Eigen::Vector3f p_laser;  ///< metres
  float intensity = std::numeric_limits<float>::quiet_NaN();
  double time = 0.0;  ///< seconds after the cloud's stamp
};

/// One cloud of a 3D laser (MultiSense and kin); each point keeps its own time. A point whose time is not
/// finite or more than 10 s off the stamp is dropped as bad_time.
[[nodiscard]] Reading readingFromCloud(Time stamp, std::span<const CloudPoint> points, const Laser& laser);

}  // namespace thermovox
