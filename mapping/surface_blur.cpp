#include "mapping/surface_blur.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mapping/plane_basis.hpp"

namespace thermovox {
namespace {

constexpr double kUnknownBlur = 0.5;                               // px
constexpr double kUnknownBlurSigma = 0.3;                          // as a share
constexpr double kInterpolation = 1.0 / 6.0;                       // variance of linear interpolation, px^2
constexpr double kLeastCosine = 0.2;                               // of ray and normal
constexpr double kFront = 0.42;                                    // likewise
constexpr Duration kBesideFrame = std::chrono::milliseconds(500);  // that a return may be from its frame
constexpr double kRangeSlack = 0.25;                               // metres: what a body moves between frames

using PixelByP = Eigen::Matrix<double, 2, 3>;

/// d pixel / d p_world (px / m) of the views that a sample's temperatures may be from: of one temperature the
/// frame of its time that was as far away as the cell remembers, of several all frames of their time that had
/// the sample in their picture, and were no nearer.
std::vector<PixelByP> viewsOf(const SurfaceSample& sample, const CameraSight& camera) {
  const double range = sample.best_view.range;
  double nearest = kRangeSlack;
  std::vector<PixelByP> views;
  for (const FramePose& frame : camera.frames) {
    if (frame.stamp < sample.first - kBesideFrame || frame.stamp > sample.last + kBesideFrame) continue;
    const Pose T_camera_world = frame.T_world_camera.inverse();
    const Eigen::Vector3d p_camera = T_camera_world * sample.p_world;
    const double further = p_camera.norm() - range;
    const bool may_be = sample.observations > 1 ? further > -kRangeSlack : std::abs(further) < nearest;
    if (!may_be || !camera.lens || !camera.lens->project(p_camera)) continue;
    if (sample.observations == 1) views.clear();
    nearest = std::abs(further);
    views.emplace_back(camera.lens->jacobian(p_camera) * T_camera_world.matrix());
  }
  return views;
}

/// That of a camera without distortion that looked straight at it, as far off the normal as the cell
/// remembers, else along the normal.
PixelByP viewWithoutFrame(const SurfaceSample& sample, const Eigen::Vector3d& normal,
                          const CameraSight& camera) {
  const double range = std::max<double>(sample.best_view.range, 0.01);
  const double incidence = std::isnan(sample.best_view.incidence) ? 0.0 : sample.best_view.incidence;
  const Eigen::Vector3d n = normal.isZero() ? Eigen::Vector3d::UnitZ() : normal;
  const Eigen::Vector3d ray = std::cos(incidence) * n + std::sin(incidence) * n.unitOrthogonal();
  return camera.focal_px / range * planeBasis(ray).transpose();
}

}  // namespace

CameraSight sightOf(const ThermalCamera& camera, std::vector<FramePose> frames) {
  CameraSight sight{.focal_px = std::sqrt(camera.camera.fx() * camera.camera.fy()),
                    .blur_px = camera.blur_px,
                    .bias_sigma = camera.bias_sigma,
                    .lens = camera.camera,
                    .frames = std::move(frames)};
  if (!camera.knows_blur) {
    sight.blur_px = kUnknownBlur;
    sight.blur_sigma = kUnknownBlurSigma;
  }
  return sight;
}

double imageBlur(const CameraSight& camera) {
  return std::sqrt(camera.blur_px * camera.blur_px + kInterpolation);
}

bool SurfaceBlur::fromTheFront() const {
  return kFront * kFront * (variance + oblique.squaredNorm()) <= variance;
}

SurfaceBlur surfaceBlur(std::span<const PixelByP> views, const Eigen::Vector3d& normal, double blur_px) {
  const Eigen::Vector3d ray = views.front().row(0).cross(views.front().row(1)).normalized();
  const Eigen::Matrix<double, 3, 2> surface = planeBasis(normal.isZero() ? ray : normal);
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();  // px^2 / m^2
  for (const PixelByP& pixel_by_p : views) {
    const Eigen::Matrix2d by_surface = pixel_by_p * surface;
    squares += by_surface.transpose() * by_surface / static_cast<double>(views.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(squares);
  const double most = axes.eigenvalues()[1];
  const double least = std::max(axes.eigenvalues()[0], kLeastCosine * kLeastCosine * most);
  if (!(most > 0.0)) return {};
  const double b2 = blur_px * blur_px;
  return {b2 / most, std::sqrt(b2 / least - b2 / most) * surface * axes.eigenvectors().col(0)};
}

SurfaceBlur blurOf(const SurfaceSample& sample, const Eigen::Vector3d& normal, const CameraSight& camera) {
  std::vector<PixelByP> views = viewsOf(sample, camera);
  if (views.empty()) views.push_back(viewWithoutFrame(sample, normal, camera));
  return surfaceBlur(views, normal, imageBlur(camera));
}

}  // namespace thermovox
