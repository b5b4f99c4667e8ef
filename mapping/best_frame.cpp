#include "mapping/best_frame.hpp"

#include <algorithm>
#include <cmath>

namespace thermovox {

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

}  // namespace thermovox
