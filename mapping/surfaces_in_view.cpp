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
    if (block.surfaceCount() == 0) return;
    const Eigen::Vector3d corner = Eigen::Vector3d(key.x, key.y, key.z) * block_edge;
    if (!mayBeInFront(T_camera_world * (corner + Eigen::Vector3d::Constant(0.5 * block_edge)), radius))
      return;
    block.forEachSurface([&](int index, const SurfaceCell& surface) {
      if (!map.occupancyModel().isOccupied(block.log_odds[index])) return;
      const CellKey cell = cellAt(key, index);
      depths.add((Eigen::Vector3d(cell.x, cell.y, cell.z) + surface.meanOffset()) * map.resolution());
    });
  });
}

}  // namespace thermovox
