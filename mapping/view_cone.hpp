#pragma once

#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// The cone about a camera's optical axis that holds its image and a rim around it, as far as some range:
/// what lies outside neither is in the picture nor hides anything in it.
class ViewCone {
 public:
  /// Of a camera that stands at T_camera_world; `range` in metres from its centre.
  ViewCone(const Camera& camera, const Pose& T_camera_world, double range);

  /// Whether a ball (world, metres) may reach into the cone.
  [[nodiscard]] bool mayHold(const Eigen::Vector3d& center_world, double radius) const;

 private:
  Pose T_camera_world_;
  double range_;
  double half_angle_ = 0.0;  ///< radians
};

}  // namespace thermovox
