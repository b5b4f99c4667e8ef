#include "mapping/surfaces_in_view.hpp"

#include <cmath>

namespace thermovox {
namespace {

/// May a block lie before the camera? By its bounding sphere and the camera's image plane.
bool mayBeInFront(const Eigen::Vector3d& center_camera, double radius) {
  return center_camera.z() > -radius;
}

}  // namespace

void addSurfacesInView(const ThermalMap& map, const Pose& T_camera_world, DepthSectors& depths) {
  const double block_edge = map.resolution() * kBlockEdge;
  const double radius = 0.5 * std::sqrt(3.0) * block_edge;
  map.forEachBlock([&](const BlockKey& key, const Block& block) {
    if (block.surfaces.empty()) return;
    const Eigen::Vector3d corner = Eigen::Vector3d(key.x, key.y, key.z) * block_edge;
    if (!mayBeInFront(T_camera_world * (corner + Eigen::Vector3d::Constant(0.5 * block_edge)), radius))
      return;
    for (std::size_t i = 0; i < block.surfaces.size(); ++i) {
      if (!map.occupancyModel().isOccupied(block.log_odds[block.surface_index[i]])) continue;
      const CellKey cell = cellAt(key, block.surface_index[i]);
      const Eigen::Vector3d place = Eigen::Vector3d(cell.x, cell.y, cell.z) + block.surfaces[i].meanOffset();
      depths.add(place * map.resolution());
    }
  });
}

}  // namespace thermovox
