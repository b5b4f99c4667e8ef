#include "mapping/moved_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Throws DataError unless the map reaches as far as the point.
void checkReach(const Eigen::Vector3d& p_world, double resolution) {
  const double reach = (kMaxCellKey - kBlockEdge) * resolution;
  if (p_world.cwiseAbs().maxCoeff() < reach) return;
  std::ostringstream message;
  message << "a cell would move to (" << p_world.transpose() << ") m, expected coordinates within " << reach
          << " m of the origin";
  throw DataError(message.str());
}

/// Where a block lies after a motion, its corners' box, metres.
Eigen::AlignedBox3d movedBox(const BlockKey& key, double block_edge, const Pose& T_to_from) {
  const Eigen::Vector3d corner = Eigen::Vector3d(key.x, key.y, key.z) * block_edge;
  Eigen::AlignedBox3d box;
  for (int i = 0; i < 8; ++i)
    box.extend(T_to_from * (corner + block_edge * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2)));
  return box;
}

/// Calls visit(x, y, z) for all cubes of a grid that a box touches.
template <typename Visitor>
void forEachTouched(const Eigen::AlignedBox3d& box, double edge, Visitor&& visit) {
  const Eigen::Vector3i low = (box.min() / edge).array().floor().cast<int>();
  const Eigen::Vector3i high = (box.max() / edge).array().floor().cast<int>();
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) visit(x, y, z);
    }
  }
}

/// Tiles that the map may touch after the motion.
std::set<TileKey> touchedTiles(const ThermalMap& map, const Pose& T_world_map) {
  const double edge = kBlockEdge * map.resolution();
  std::set<TileKey> touched;
  map.forEachBlock([&](const BlockKey& key, const Block&) {
    const Eigen::AlignedBox3d box = movedBox(key, edge, T_world_map);
    checkReach(box.min(), map.resolution());
    checkReach(box.max(), map.resolution());
    forEachTouched(box, kTileEdge * edge, [&](int x, int y, int z) { touched.insert({x, y, z}); });
  });
  return touched;
}

/// The tiles of a map around one place: each is brought once from where the map keeps it.
class TilesAtHand {
 public:
  explicit TilesAtHand(const ThermalMap& map) : map_(map) {}

  [[nodiscard]] const Block* block(const BlockKey& key) {
    const auto [place, is_new] = tiles_.try_emplace(tileOf(key));
    if (is_new) place->second = map_.tile(place->first);
    return place->second != nullptr ? std::as_const(*place->second).block(indexInTile(key)) : nullptr;
  }

 private:
  const ThermalMap& map_;
  std::unordered_map<TileKey, std::shared_ptr<const MapTile>, TileKeyHash> tiles_;
};

bool anyBlockIn(const Eigen::AlignedBox3d& box, double block_edge, TilesAtHand& tiles) {
  bool found = false;
  forEachTouched(box, block_edge, [&](int x, int y, int z) { found = found || tiles.block({x, y, z}); });
  return found;
}

/// The block's log-odds, each from where its cell's centre was; whether any is known.
bool sampleLogOdds(const BlockKey& key, const ThermalMap& map, const Pose& T_map_world, TilesAtHand& tiles,
                   Block& block) {
  bool known = false;
  for (int i = 0; i < kBlockCells; ++i) {
    const CellKey from = map.keyOf(T_map_world * map.centerOf(cellAt(key, i)));
    const Block* found = tiles.block(blockOf(from));
    const LogOdds log_odds = found != nullptr ? found->log_odds[indexInBlock(from)] : kUnknown;
    if (log_odds == kUnknown) continue;
    block.log_odds.set(i, log_odds);
    known = true;
  }
  return known;
}

void addLogOdds(const ThermalMap& map, const Pose& T_world_map, ThermalMap& result) {
  const Pose T_map_world = T_world_map.inverse();
  const double edge = kBlockEdge * map.resolution();
  for (const TileKey& tile : touchedTiles(map, T_world_map)) {
    TilesAtHand tiles(map);
    for (int index = 0; index < kTileBlocks; ++index) {
      const BlockKey key = blockAt(tile, index);
      if (!anyBlockIn(movedBox(key, edge, T_map_world), edge, tiles)) continue;
      Block block;
      if (sampleLogOdds(key, map, T_map_world, tiles, block)) result.mergeBlock(key, block);
    }
  }
}

/// The same statistics, at another place within a cell (in edges).
SurfaceCell placedAt(SurfaceCell cell, const Eigen::Vector3d& offset) {
  for (int i = 0; i < 3; ++i) {
    const double step =
        std::clamp(std::floor(offset[i] * SurfaceCell::kOffsetSteps), 0.0, SurfaceCell::kOffsetSteps - 1.0);
    cell.offset_sum[static_cast<std::size_t>(i)] = cell.returns * static_cast<std::uint64_t>(step);
  }
  return cell;
}

/// Adds the surfaces of a tile.
void addSurfaces(const TileKey& tile_key, const MapTile& tile, const Pose& T_world_map, ThermalMap& result) {
  const double resolution = result.resolution();
  std::map<BlockKey, Block> blocks;
  tile.forEachBlock([&](int block_index, const Block& block) {
    block.forEachSurface([&](int index, const SurfaceCell& cell) {
      const CellKey key = cellAt(blockAt(tile_key, block_index), index);
      const Eigen::Vector3d in_cells = Eigen::Vector3d(key.x, key.y, key.z) + cell.meanOffset();
      const Eigen::Vector3d p_world = T_world_map * Eigen::Vector3d(in_cells * resolution);
      checkReach(p_world, resolution);
      const CellKey moved = result.keyOf(p_world);
      const Eigen::Vector3d offset = p_world / resolution - Eigen::Vector3d(moved.x, moved.y, moved.z);
      blocks[blockOf(moved)].surfaceOrNew(indexInBlock(moved)).merge(placedAt(cell, offset));
    });
  });
  for (const auto& [key, block] : blocks) result.mergeBlock(key, block);
}

}  // namespace

void addMoved(const ThermalMap& map, const Pose& T_world_map, ThermalMap& result) {
  if (map.options() != result.options())
    throw ConfigError("a map to move: expected the resolution and occupancy model of what it is added to");
  addLogOdds(map, T_world_map, result);
  map.forEachTile(
      [&](const TileKey& key, const MapTile& tile) { addSurfaces(key, tile, T_world_map, result); });
}

}  // namespace thermovox
