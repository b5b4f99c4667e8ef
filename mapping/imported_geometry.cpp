#include "mapping/imported_geometry.hpp"

#include <vector>

#include "projection/error.hpp"

namespace thermovox {

void addGeometry(std::span<const Eigen::Vector3d> points_world, ThermalMap& map) {
  std::vector<MappedReturn> reading;
  reading.reserve(points_world.size());
  for (const Eigen::Vector3d& p_world : points_world) {
    if (p_world.allFinite()) reading.push_back({p_world, p_world, Time{}, std::nullopt});
  }
  if (reading.empty()) {
    throw DataError("the imported cloud has no finite point among its " +
                    std::to_string(points_world.size()) + ", expected at least one");
  }
  map.integrate(reading, Carving::none);
}

}  // namespace thermovox
