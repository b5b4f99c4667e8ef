#pragma once

#include <Eigen/Core>
#include <vector>

namespace thermovox {

/// The rays of a scanner's sweeps, each direction once: those that share an angle are one. Ascending angles.
struct ScanRay {
  double angle = 0.0;                ///< radians, of the first return
  double range = 0.0;                ///< metres, the median of its returns
  std::vector<std::size_t> returns;  ///< places in the returns
};

[[nodiscard]] std::vector<ScanRay> scanRays(const std::vector<Eigen::Vector3d>& returns_laser);

/// Straight pieces of a scan that a plate (its two sides, metres) may be; see boardCandidates().
[[nodiscard]] std::vector<std::vector<Eigen::Vector3d>> boardsInScan(
    const std::vector<Eigen::Vector3d>& returns_laser, const Eigen::Vector2d& plate);

}  // namespace thermovox
