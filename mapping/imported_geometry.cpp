#include "mapping/imported_geometry.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "projection/error.hpp"

namespace thermovox {
namespace {

MappedReturn returnAt(const Eigen::Vector3d& p_world) {
  return {p_world, p_world, Time{}, std::nullopt};
}

/// One of the points, and the tile in which it lies.
struct TiledPoint {
  TileKey tile;
  std::size_t index = 0;
  friend bool operator<(const TiledPoint& a, const TiledPoint& b) {
    return std::tie(a.tile, a.index) < std::tie(b.tile, b.index);
  }
};

/// The finite ones tile by tile, in each in their own order.
std::vector<TiledPoint> byTiles(std::span<const Eigen::Vector3d> points_world, const ThermalMap& map) {
  std::vector<TiledPoint> points;
  points.reserve(points_world.size());
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    if (!points_world[i].allFinite()) continue;
    map.check({{returnAt(points_world[i])}});
    points.push_back({tileOf(blockOf(map.keyOf(points_world[i]))), i});
  }
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace

void addGeometry(std::span<const Eigen::Vector3d> points_world, ThermalMap& map) {
  const std::vector<TiledPoint> points = byTiles(points_world, map);
  if (points.empty()) {
    throw DataError("the imported cloud has no finite point among its " +
                    std::to_string(points_world.size()) + ", expected at least one");
  }
  // What has no rays is the same in one reading or in one for each tile, and so only one need be in memory.
  std::vector<MappedReturn> reading;
  for (auto begin = points.begin(); begin != points.end();) {
    reading.clear();
    auto end = begin;
    for (; end != points.end() && end->tile == begin->tile; ++end)
      reading.push_back(returnAt(points_world[end->index]));
    map.integrate(reading, Carving::none);
    begin = end;
  }
}

}  // namespace thermovox
