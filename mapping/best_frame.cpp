#include "mapping/best_frame.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

constexpr double kBetweenFrames = 0.1;  // metres that a body moves from a frame to a return coloured by it

}  // namespace

void findBestFrame(Hotspot& spot, std::span<const FramePose> frames, const ThermalCamera& camera,
                   double resolution) {
  double nearest = kBetweenFrames + resolution;
  const FramePose* best = nullptr;
  for (const FramePose& frame : frames) {
    const Pose T_camera_world = frame.T_world_camera.inverse();
    const Eigen::Vector3d p_camera = T_camera_world * spot.best_seen;
    const double off = std::abs(p_camera.norm() - static_cast<double>(spot.best_view.range));
    if (off >= nearest) continue;
    const std::optional<Eigen::Vector2d> cell = camera.camera.project(p_camera);
    if (!cell) continue;
    nearest = off;
    best = &frame;
    const std::optional<Eigen::Vector2d> peak = camera.camera.project(T_camera_world * spot.position.p_world);
    spot.best_frame = SeenInFrame{frame.stamp, peak.value_or(*cell)};
  }
  if (best == nullptr || spot.normal.isZero() || !std::isnan(spot.best_view.incidence)) return;
  const Eigen::Vector3d d_world = (spot.position.p_world - best->T_world_camera.translation).normalized();
  const double cosine = std::min(std::abs(d_world.dot(spot.normal)), 1.0);
  spot.best_view.incidence = static_cast<float>(std::acos(cosine));
}

}  // namespace thermovox
