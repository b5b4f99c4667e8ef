#include "mapping/surfaces_in_view.hpp"

#include <cmath>

namespace thermovox {

void addSurfacesInView(const ThermalMap& map, const ViewCone& cone, DepthSectors& depths) {
  const double block_edge = map.resolution() * kBlockEdge;
  const double radius = 0.5 * std::sqrt(3.0) * block_edge;
  const auto tileInView = [&](const TileKey& key) {
    const Eigen::Vector3d center =
        (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5) * kTileEdge * block_edge;
    return cone.mayHold(center, kTileEdge * radius);
  };
  map.forEachBlockOfTiles(tileInView, [&](const BlockKey& key, const Block& block) {
    if (block.surfaceCount() == 0) return;
    const Eigen::Vector3d corner = Eigen::Vector3d(key.x, key.y, key.z) * block_edge;
    if (!cone.mayHold(corner + Eigen::Vector3d::Constant(0.5 * block_edge), radius)) return;
    block.forEachSurface([&](int index, const SurfaceCell& surface) {
      if (!map.occupancyModel().isOccupied(block.log_odds[index])) return;
      const CellKey cell = cellAt(key, index);
      depths.add((Eigen::Vector3d(cell.x, cell.y, cell.z) + surface.meanOffset()) * map.resolution());
    });
  });
}

}  // namespace thermovox
