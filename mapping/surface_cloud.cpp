#include "mapping/surface_cloud.hpp"

#include <cmath>

namespace thermovox {
namespace {

/// -1, 0 or 1: the float lies below, in or above cell k, by either way to compute its key.
int sideOf(float coordinate, std::int32_t k, double resolution) {
  const double x = coordinate;
  const double low = std::min(std::floor(x / resolution), std::floor(x * (1.0 / resolution)));
  const double high = std::max(std::floor(x / resolution), std::floor(x * (1.0 / resolution)));
  return low < k ? -1 : (high > k ? 1 : 0);
}

/// The float nearest to the coordinate that lies in cell k: rounding may have carried it over the border.
float floatInCell(double coordinate, std::int32_t k, double resolution) {
  auto nearest = static_cast<float>(coordinate);
  const auto center = static_cast<float>((k + 0.5) * resolution);
  while (nearest != center && sideOf(nearest, k, resolution) != 0) nearest = std::nextafter(nearest, center);
  return nearest;
}

}  // namespace

SurfacePoint surfacePoint(const ThermalMap& map, const CellKey& key, const SurfaceCell& cell) {
  const double resolution = map.resolution();
  const Eigen::Vector3d p_world = (Eigen::Vector3d(key.x, key.y, key.z) + cell.meanOffset()) * resolution;
  SurfacePoint point;
  point.p_world = {floatInCell(p_world.x(), key.x, resolution), floatInCell(p_world.y(), key.y, resolution),
                   floatInCell(p_world.z(), key.z, resolution)};
  if (cell.observations > 0) {
    point.temperature = {static_cast<float>(cell.mean()), static_cast<float>(cell.sigmaOfMean()),
                         static_cast<std::uint32_t>(cell.observations), toUnixSeconds(cell.last())};
  }
  return point;
}

std::vector<SurfacePoint> surfaceCloud(const ThermalMap& map) {
  std::vector<SurfacePoint> cloud;
  cloud.reserve(map.surfaceCount());
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    cloud.push_back(surfacePoint(map, key, cell));
  });
  return cloud;
}

}  // namespace thermovox
