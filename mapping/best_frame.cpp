#include "mapping/best_frame.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

constexpr Duration kBesideFrame = std::chrono::milliseconds(500);  // that a return may be from its frame
constexpr double kRangeSlack = 0.25;                               // metres: what a body moves between frames

}  // namespace

void findBestFrame(Hotspot& spot, std::span<const FramePose> frames, const ThermalCamera& camera,
                   double resolution) {
  double nearest = 0.01 + resolution;
  const FramePose* best = nullptr;
  for (const FramePose& frame : frames) {
    const Eigen::Vector3d p_camera = frame.T_world_camera.inverse() * spot.position.p_world;
    const double off = std::abs(p_camera.norm() - static_cast<double>(spot.best_view.range));
    if (off >= nearest) continue;
    const std::optional<Eigen::Vector2d> pixel = camera.camera.project(p_camera);
    if (!pixel) continue;
    nearest = off;
    best = &frame;
    spot.best_frame = SeenInFrame{frame.stamp, *pixel};
  }
  if (best == nullptr || spot.normal.isZero() || !std::isnan(spot.best_view.incidence)) return;
  const Eigen::Vector3d d_world = (spot.position.p_world - best->T_world_camera.translation).normalized();
  const double cosine = std::min(std::abs(d_world.dot(spot.normal)), 1.0);
  spot.best_view.incidence = static_cast<float>(std::acos(cosine));
}

Eigen::Vector3d viewOf(const SurfaceSample& sample, const Eigen::Vector3d& normal,
                       std::span<const FramePose> frames) {
  const double range = sample.best_view.range;
  double nearest = kRangeSlack;
  std::optional<Eigen::Vector3d> view;
  for (const FramePose& frame : frames) {
    if (frame.stamp < sample.first - kBesideFrame || frame.stamp > sample.last + kBesideFrame) continue;
    const Eigen::Vector3d from_frame = sample.p_world - frame.T_world_camera.translation;
    const double off = std::abs(from_frame.norm() - range);
    if (off >= nearest || !((frame.T_world_camera.inverse() * sample.p_world).z() > 0.0)) continue;
    nearest = off;
    view = from_frame;
  }
  if (view) return view->normalized() * range;
  if (normal.isZero()) return range * Eigen::Vector3d::UnitZ();
  const double incidence = std::isnan(sample.best_view.incidence) ? 0.0 : sample.best_view.incidence;
  return range * (std::cos(incidence) * normal + std::sin(incidence) * normal.unitOrthogonal());
}

}  // namespace thermovox
