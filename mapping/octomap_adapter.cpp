#include "mapping/octomap_adapter.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::uint64_t kMostCells = std::uint64_t{1} << 32;

/// OctoMap's own prune() looks at the occupancy only and averages the colours.
class ExactColorTree : public octomap::ColorOcTree {
 public:
  using ColorOcTree::ColorOcTree;

  bool isNodeCollapsible(const octomap::ColorOcTreeNode* node) const override {
    if (!nodeChildExists(node, 0)) return false;
    const octomap::ColorOcTreeNode& first = *getNodeChild(node, 0);
    for (unsigned i = 0; i < 8; ++i) {
      if (!nodeChildExists(node, i)) return false;
      const octomap::ColorOcTreeNode& child = *getNodeChild(node, i);
      if (nodeHasChildren(&child) || !(child == first)) return false;
    }
    return true;
  }
};

octomap::OcTreeKey octomapKey(const CellKey& key) {
  const auto reach = [](int k) { return k >= -kOctomapReach && k < kOctomapReach; };
  if (!reach(key.x) || !reach(key.y) || !reach(key.z)) {
    std::ostringstream message;
    message << "the cell (" << key.x << ", " << key.y << ", " << key.z << ") is beyond OctoMap's "
            << kOctomapReach
            << " cells from the origin, expected a map nearer to it: use a local origin or larger cells";
    throw DataError(message.str());
  }
  const auto shifted = [](int k) { return static_cast<octomap::key_type>(k + kOctomapReach); };
  return {shifted(key.x), shifted(key.y), shifted(key.z)};
}

CellKey cellKeyOf(const octomap::OcTreeKey& key) {
  return {key[0] - kOctomapReach, key[1] - kOctomapReach, key[2] - kOctomapReach};
}

/// Calls visit(octomap key, index in the block, block) for all known cells in key order.
template <typename Visitor>
void forEachKnown(const ThermalMap& map, Visitor&& visit) {
  for (const BlockKey& block_key : map.sortedBlockKeys()) {
    const Block& block = *map.block(block_key);
    for (int index = 0; index < kBlockCells; ++index) {
      if (block.log_odds[index] == kUnknown) continue;
      visit(octomapKey(cellAt(block_key, index)), index, block);
    }
  }
}

template <typename Tree>
std::unique_ptr<Tree> emptyTree(const ThermalMap& map) {
  auto tree = std::make_unique<Tree>(map.resolution());
  const OccupancyModel::Options& options = map.options().occupancy;
  tree->setProbHit(options.prob_hit);
  tree->setProbMiss(options.prob_miss);
  tree->setClampingThresMin(options.clamp_min);
  tree->setClampingThresMax(options.clamp_max);
  tree->setOccupancyThres(options.occupied);
  return tree;
}

float treeLogOdds(const ThermalMap& map, const Block& block, int index) {
  return static_cast<float>(map.occupancyModel().naturalLogOdds(block.log_odds[index]));
}

/// OctoMap keeps probabilities as 32-bit log-odds; six decimals bring back what was set.
double rounded(double probability) {
  return std::round(probability * 1e6) / 1e6;
}

/// A leaf's log-odds, clamped as the model clamps a mission's own.
LogOdds inQuanta(float log_odds, const OccupancyModel& model) {
  if (!std::isfinite(log_odds)) {
    throw DataError("an OctoMap holds a cell with log-odds of " + std::to_string(log_odds) +
                    ", expected finite numbers");
  }
  const double quanta = std::clamp<double>(log_odds / model.quantum(), model.clampMin(), model.clampMax());
  return static_cast<LogOdds>(std::lround(quanta));
}

ThermalMap::Options optionsOf(const octomap::OcTree& tree) {
  return {tree.getResolution(),
          {rounded(tree.getProbHit()), rounded(tree.getProbMiss()), rounded(tree.getClampingThresMin()),
           rounded(tree.getClampingThresMax()), rounded(tree.getOccupancyThres())}};
}

}  // namespace

std::unique_ptr<octomap::OcTree> toOcTree(const ThermalMap& map) {
  auto tree = emptyTree<octomap::OcTree>(map);
  forEachKnown(map, [&](const octomap::OcTreeKey& key, int index, const Block& block) {
    tree->setNodeValue(key, treeLogOdds(map, block, index), true);
  });
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

std::unique_ptr<octomap::ColorOcTree> toColorOcTree(const ThermalMap& map, const SurfaceColor& color,
                                                    const octomap::ColorOcTreeNode::Color& elsewhere) {
  auto tree = emptyTree<ExactColorTree>(map);
  forEachKnown(map, [&](const octomap::OcTreeKey& key, int index, const Block& block) {
    octomap::ColorOcTreeNode* node = tree->setNodeValue(key, treeLogOdds(map, block, index), true);
    if (const SurfaceCell* cell = block.surface(index)) node->setColor(color(*cell));
  });
  tree->updateInnerOccupancy();
  tree->prune();
  for (auto node = tree->begin_tree(); node != tree->end_tree(); ++node) {
    if (!node->isColorSet()) node->setColor(elsewhere);
  }
  return tree;
}

ThermalMap fromOcTree(const octomap::OcTree& tree) {
  ThermalMap map(optionsOf(tree));
  std::unordered_map<BlockKey, Block, BlockKeyHash> blocks;
  std::uint64_t cells = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const std::int32_t edge = 1 << (tree.getTreeDepth() - leaf.getDepth());
    cells += static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge) *
             static_cast<std::uint64_t>(edge);
    if (cells > kMostCells) {
      throw DataError(
          "an OctoMap of more than 2^32 cells was given, expected one that fits into memory unpruned");
    }
    const LogOdds log_odds = inQuanta(leaf->getLogOdds(), map.occupancyModel());
    const CellKey corner = cellKeyOf(leaf.getIndexKey());
    for (std::int32_t z = corner.z; z < corner.z + edge; ++z) {
      for (std::int32_t y = corner.y; y < corner.y + edge; ++y) {
        for (std::int32_t x = corner.x; x < corner.x + edge; ++x) {
          blocks[blockOf({x, y, z})].log_odds.set(indexInBlock({x, y, z}), log_odds);
        }
      }
    }
  }
  for (auto& [key, block] : blocks) map.setBlock(key, std::move(block));
  return map;
}

}  // namespace thermovox
