#include "apps/imported_cloud.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "io/point_cloud_file.hpp"
#include "mapping/imported_geometry.hpp"
#include "projection/error.hpp"

namespace thermovox {

std::string cloudName(const std::filesystem::path& file) {
  return file.stem().string();
}

MissionRecord importCloud(const std::filesystem::path& file, ThermalMap& map) {
  std::vector<Eigen::Vector3d> points_world;
  for (const CloudPoint& point : readCloudPoints(file, "--geometry")) {
    points_world.push_back(point.p_laser.cast<double>());
  }
  try {
    addGeometry(points_world, map);
  } catch (const DataError& error) {
    throw DataError(file.string() + ": " + error.what());
  }
  const nlohmann::ordered_json parameters{{"geometry", file.filename().string()}};
  return {.name = cloudName(file),
          .parameters = parameters.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace),
          .points = static_cast<std::int64_t>(points_world.size())};
}

}  // namespace thermovox
