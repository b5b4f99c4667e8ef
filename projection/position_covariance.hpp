#pragma once

#include <Eigen/Core>

#include "projection/mission.hpp"

namespace thermovox {

/// Where a laser return's position error comes from, as covariances in the world frame, m^2.
struct PositionCovariance {
  Eigen::Matrix3d random = Eigen::Matrix3d::Zero();  ///< range noise: new for every return
  /// Range bias and extrinsics: shared by all returns of the laser, and not by the camera, so that it moves
  /// the point in the image.
  Eigen::Matrix3d extrinsic = Eigen::Matrix3d::Zero();
  /// Pose error common to the mission: it moves camera and laser together, so that it does not move the
  /// point in the image, but it moves it in the world.
  Eigen::Matrix3d pose = Eigen::Matrix3d::Zero();

  [[nodiscard]] Eigen::Matrix3d total() const { return random + extrinsic + pose; }
};

/// First-order propagation of what rig and mission declare to one return at p_laser (metres, laser frame).
///   p_body  = R_body_laser p_laser + t;   d p_body = -[R_body_laser p_laser]x w + v + d d_range
///   p_world = R_world_body p_body + t';   d p_world = R_world_body d p_body - [R_world_body p_body]x w' + v'
/// with (w, v) of covariance_body_laser, (w', v') of the mission's pose sigmas and d the ray's direction.
[[nodiscard]] PositionCovariance positionCovariance(const Mission& mission, const Laser& laser,
                                                    const Pose& T_world_body, const Eigen::Vector3d& p_laser);

}  // namespace thermovox
