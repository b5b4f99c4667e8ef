#include "mapping/intrinsics_error.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "mapping/plane_basis.hpp"

namespace thermovox {
namespace {

constexpr double kLeastCosine = 0.2;  // of ray and normal, as for the blur
constexpr double kStep = 1e-6;        // of a parameter, for differences

/// d pixel / d (fx fy cx cy, distortion), by central differences: the constructor takes all that a lens has.
std::optional<Eigen::MatrixXd> pixelByIntrinsics(const Camera& camera, const Eigen::Vector3d& p_camera,
                                                 Eigen::Index parameters) {
  Eigen::MatrixXd derivative(2, parameters);
  for (Eigen::Index i = 0; i < parameters; ++i) {
    Intrinsics less = camera.intrinsics(), more = less;
    double& low = less.parameters.at(static_cast<std::size_t>(i));
    double& high = more.parameters.at(static_cast<std::size_t>(i));
    const double step = kStep * std::max(1.0, std::abs(low));
    low -= step;
    high += step;
    const auto from = Camera(less).projectUnbounded(p_camera), to = Camera(more).projectUnbounded(p_camera);
    if (!from || !to) return std::nullopt;
    derivative.col(i) = (*to - *from) / (high - low);
  }
  return derivative;
}

bool sees(const FramePose& frame, const Eigen::Vector3d& p_world, const Camera& camera) {
  return camera.project(frame.T_world_camera.inverse() * p_world).has_value();
}

/// For a spot seen in one frame; none where the lens has no place for it.
std::optional<Eigen::Matrix3d> covarianceIn(const FramePose& frame, const Hotspot& spot,
                                            const ThermalCamera& camera) {
  const Pose T_camera_world = frame.T_world_camera.inverse();
  const Eigen::Vector3d p_camera = T_camera_world * spot.position.p_world;
  const auto by_intrinsics = pixelByIntrinsics(camera.camera, p_camera, camera.covariance_intrinsics.rows());
  if (!by_intrinsics) return std::nullopt;
  const Eigen::Vector3d ray = (T_camera_world.matrix().transpose() * p_camera).normalized();
  const bool faces = spot.normal.isZero() || std::abs(spot.normal.dot(ray)) < kLeastCosine;
  const Eigen::Vector3d normal = faces ? ray : spot.normal;
  const Eigen::Matrix<double, 3, 2> surface = planeBasis(normal);
  const Eigen::Matrix2d by_surface = camera.camera.jacobian(p_camera) * T_camera_world.matrix() * surface;
  const Eigen::MatrixXd moved = surface * by_surface.inverse() * *by_intrinsics;
  return moved * camera.covariance_intrinsics * moved.transpose();
}

}  // namespace

Eigen::Matrix3d intrinsicsCovariance(const Hotspot& spot, std::span<const FramePose> frames,
                                     const ThermalCamera& camera) {
  Eigen::Matrix3d widest = Eigen::Matrix3d::Zero();
  if (camera.covariance_intrinsics.size() == 0) return widest;
  for (const FramePose& frame : frames) {
    const bool is_it = spot.best_frame ? frame.stamp == spot.best_frame->stamp
                                       : sees(frame, spot.position.p_world, camera.camera);
    if (!is_it) continue;
    const auto covariance = covarianceIn(frame, spot, camera);
    if (covariance && covariance->trace() > widest.trace()) widest = *covariance;
  }
  return widest;
}

}  // namespace thermovox
