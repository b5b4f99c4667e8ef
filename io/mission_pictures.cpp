#include "io/mission_pictures.hpp"

#include <vector>

namespace thermovox {

MissionPictures::MissionPictures(const OpenedMission& opened, Duration within)
    : mission_(opened.mission),
      pictures_(*opened.visible_list, opened.folder, opened.mission.rig.visible_camera->camera),
      within_(within) {}

std::shared_ptr<const RegisteredPicture> MissionPictures::on(Time frame,
                                                             std::span<const Eigen::Vector3d> points_world) {
  std::optional<VisibleFrame> visible = pictures_.nearest(frame, within_);
  if (!visible) return nullptr;
  const auto body_then = mission_.trajectory.at(frame);
  const auto body_at_picture = mission_.trajectory.at(visible->stamp);
  const auto* T_world_body = std::get_if<Pose>(&body_then);
  const auto* T_world_body_picture = std::get_if<Pose>(&body_at_picture);
  if (T_world_body == nullptr || T_world_body_picture == nullptr) return nullptr;
  const ThermalCamera& thermal = *mission_.rig.thermal_camera;
  const MountedCamera& other = *mission_.rig.visible_camera;
  const Pose T_thermal_world = (*T_world_body * thermal.T_body_camera).inverse();
  std::vector<PixelDepth> points;
  for (const Eigen::Vector3d& p_world : points_world) {
    const Eigen::Vector3d p_thermal = T_thermal_world * p_world;
    if (const auto pixel = thermal.camera.project(p_thermal)) points.push_back({*pixel, p_thermal.z()});
  }
  const Pose T_visible_thermal =
      (*T_world_body_picture * other.T_body_camera).inverse() * T_thermal_world.inverse();
  const auto depths = nearestDepths(thermal.camera.width(), thermal.camera.height(), points);
  return std::make_shared<RegisteredPicture>(
      RegisteredPicture{std::move(visible->picture),
                        registerPixels({thermal.camera, other.camera, T_visible_thermal}, depths)});
}

}  // namespace thermovox
