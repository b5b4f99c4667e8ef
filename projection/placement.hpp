#pragma once

#include <variant>

#include "projection/laser/laser_return.hpp"
#include "projection/mission.hpp"

namespace thermovox {

/// A laser return where it lies in the world.
struct PlacedReturn {
  Time stamp;
  Eigen::Vector3d p_world;       ///< metres
  Eigen::Vector3d origin_world;  ///< the laser's centre at that moment, metres
  double range = 0.0;            ///< the laser's own reading, metres
  /// Covariance (world, m^2) of what moves the point against the camera: range noise, range bias, extrinsics.
  Eigen::Matrix3d rig_covariance;
  Eigen::Matrix3d pose_covariance;  ///< of what moves both together
  [[nodiscard]] Eigen::Matrix3d positionCovariance() const { return rig_covariance + pose_covariance; }
};

/// p_world = T_world_body(stamp of the return) * T_body_laser * p_laser: the pose at the return's own time,
/// which is also the deskew. NoPose where the trajectory cannot say.
[[nodiscard]] std::variant<PlacedReturn, NoPose> place(const LaserReturn& laser_return, const Laser& laser,
                                                       const Mission& mission);

}  // namespace thermovox
