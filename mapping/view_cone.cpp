#include "mapping/view_cone.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

/// The rim, as a share of the image's half angle: DepthSectors asks up to 7 bins beyond an image of 160, 9 %
/// of its half width.
constexpr double kRim = 0.15;

}  // namespace

ViewCone::ViewCone(const Camera& camera, const Pose& T_camera_world, double range)
    : T_camera_world_(T_camera_world), range_(range) {
  const double right = camera.width() - 0.5;
  const double bottom = camera.height() - 0.5;
  for (const double u : {-0.5, 0.5 * right, right}) {
    for (const double v : {-0.5, 0.5 * bottom, bottom}) {
      const auto ray = camera.rayFromPixel({u, v});
      const double tangent = ray ? ray->head<2>().norm() : camera.validRadius();
      half_angle_ = std::max(half_angle_, (1.0 + kRim) * std::atan(tangent));
    }
  }
}

bool ViewCone::mayHold(const Eigen::Vector3d& center_world, double radius) const {
  const Eigen::Vector3d center_camera = T_camera_world_ * center_world;
  const double distance = center_camera.norm();
  if (distance > range_ + radius) return false;
  if (distance <= radius) return true;
  const double off_axis = std::atan2(center_camera.head<2>().norm(), center_camera.z());
  return off_axis <= half_angle_ + std::asin(radius / distance);
}

}  // namespace thermovox
