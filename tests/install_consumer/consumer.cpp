#include <iostream>
#include <optional>

#include "calibration/board_points.hpp"
#include "io/rig_file.hpp"
#include "mapping/thermal_map.hpp"
#include "projection/camera.hpp"

/// Projects a point, puts it into a map, spells an empty rig, and prints what came of each.
int main() {
  thermovox::Intrinsics intrinsics{160, 120, thermovox::LensModel::pinhole, {}, 0};
  intrinsics.parameters[thermovox::kFx] = intrinsics.parameters[thermovox::kFy] = 150.0;
  intrinsics.parameters[thermovox::kCx] = 79.5;
  intrinsics.parameters[thermovox::kCy] = 59.5;
  const thermovox::Camera camera(intrinsics);

  const Eigen::Vector3d point(0.1, -0.2, 2.0);
  const std::optional<Eigen::Vector2d> pixel = camera.project(point);
  if (!pixel) return 1;

  thermovox::ThermalMap map({});
  const thermovox::MappedReturn mapped{point, Eigen::Vector3d::Zero(), thermovox::Time{}, std::nullopt};
  map.integrate({&mapped, 1}, thermovox::Carving::octomap);

  std::cout << "pixel " << pixel->x() << " " << pixel->y() << ", cells with a surface " << map.surfaceCount()
            << ", corners " << thermovox::boardPoints({.columns = 9, .rows = 6}).size() << ", rig "
            << thermovox::rigText({});
}
