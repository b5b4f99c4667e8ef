#include "mapping/moved_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
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

/// Blocks that the block may touch after the motion.
void addTouched(const BlockKey& key, const ThermalMap& map, const Pose& T_world_map,
                std::set<BlockKey>& touched) {
  const double edge = kBlockEdge * map.resolution();
  const Eigen::Vector3d corner = Eigen::Vector3d(key.x, key.y, key.z) * edge;
  Eigen::AlignedBox3d box;
  for (int i = 0; i < 8; ++i)
    box.extend(T_world_map * (corner + edge * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2)));
  checkReach(box.min(), map.resolution());
  checkReach(box.max(), map.resolution());
  const Eigen::Vector3i low = (box.min() / edge).array().floor().cast<int>();
  const Eigen::Vector3i high = (box.max() / edge).array().floor().cast<int>();
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) touched.insert({x, y, z});
    }
  }
}

LogOdds logOddsAt(const ThermalMap& map, const Eigen::Vector3d& p_map) {
  const CellKey key = map.keyOf(p_map);
  const Block* block = map.block(blockOf(key));
  return block != nullptr ? block->log_odds[indexInBlock(key)] : kUnknown;
}

/// The block's log-odds, each from where its cell's centre was; whether any is known.
bool sampleLogOdds(const BlockKey& key, const ThermalMap& map, const Pose& T_map_world, Block& block) {
  bool known = false;
  for (int i = 0; i < kBlockCells; ++i) {
    const LogOdds log_odds = logOddsAt(map, T_map_world * map.centerOf(cellAt(key, i)));
    if (log_odds == kUnknown) continue;
    block.log_odds.set(i, log_odds);
    known = true;
  }
  return known;
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

}  // namespace

ThermalMap movedMap(const ThermalMap& map, const Pose& T_world_map) {
  std::set<BlockKey> touched;
  map.forEachBlock([&](const BlockKey& key, const Block&) { addTouched(key, map, T_world_map, touched); });
  std::map<BlockKey, Block> blocks;
  const Pose T_map_world = T_world_map.inverse();
  for (const BlockKey& key : touched) {
    Block block;
    if (sampleLogOdds(key, map, T_map_world, block)) blocks.emplace(key, std::move(block));
  }
  const double resolution = map.resolution();
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    const Eigen::Vector3d in_cells = Eigen::Vector3d(key.x, key.y, key.z) + cell.meanOffset();
    const Eigen::Vector3d p_world = T_world_map * Eigen::Vector3d(in_cells * resolution);
    checkReach(p_world, resolution);
    const CellKey moved = map.keyOf(p_world);
    const Eigen::Vector3d offset = p_world / resolution - Eigen::Vector3d(moved.x, moved.y, moved.z);
    blocks[blockOf(moved)].surfaceOrNew(indexInBlock(moved)).merge(placedAt(cell, offset));
  });
  ThermalMap result(map.options());
  for (auto& [key, block] : blocks) result.setBlock(key, std::move(block));
  return result;
}

}  // namespace thermovox
