#pragma once

#include <vector>

#include "calibration/rig_bundle.hpp"

namespace thermovox {

/// How far the observations that count are off an estimate.
struct ResidualSummary {
  std::vector<int> corners;    ///< of each camera
  std::vector<double> rms_px;  ///< of each camera: root mean square distance of a corner from its place
  double rms_mm = 0.0;         ///< of the laser's returns about the boards' planes, along the ray
};

[[nodiscard]] ResidualSummary summarise(const BundleData& data, const RigEstimate& estimate);

/// Where a ray of the laser (unit, laser frame) meets the board of a capture, metres.
[[nodiscard]] double rangeOfBoard(const RigEstimate& estimate, std::size_t capture,
                                  const Eigen::Vector3d& ray_laser);

}  // namespace thermovox
