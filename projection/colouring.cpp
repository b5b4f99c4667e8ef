#include "projection/colouring.hpp"

#include <cmath>

namespace thermovox {
namespace {

/// Mean of the two variances of S_uv = J Sigma J^T, px^2 an axis.
double pixelVariance(const Camera& camera, const ThermalView& view, const Eigen::Vector3d& p_camera,
                     const Eigen::Matrix3d& covariance_world) {
  const Eigen::Matrix<double, 2, 3> J = camera.jacobian(p_camera) * view.T_camera_world.matrix();
  const Eigen::Matrix<double, 2, 3> J_sigma = J * covariance_world;
  return 0.5 * (J_sigma.array() * J.array()).sum();
}

}  // namespace

std::variant<Colour, NoColour> colour(const PlacedReturn& point, const ThermalView& view,
                                      const ThermalCamera& camera, const Occluder& occluder) {
  const Eigen::Vector3d p_camera = view.T_camera_world * point.p_world;
  const std::optional<Eigen::Vector2d> pixel = camera.camera.project(p_camera);
  if (!pixel) return NoColour::outside_image;
  if (occluder.hides({view.T_world_camera.translation, point.p_world, *pixel, p_camera.z()}))
    return NoColour::hidden;
  const std::optional<TemperatureSample> sample = sampleTemperature(*view.frame.image, *pixel, camera.netd);
  if (!sample) return NoColour::unknown_pixel;

  const double variance_px2 = pixelVariance(camera.camera, view, p_camera, point.rig_covariance);
  const float local_variance = view.local_variance.at(*pixel, variance_px2);
  const float sigma = std::sqrt(sample->noise_sigma * sample->noise_sigma + local_variance);
  return Colour{view.frame.stamp, *pixel, sample->celsius, sigma, static_cast<float>(p_camera.norm())};
}

}  // namespace thermovox
