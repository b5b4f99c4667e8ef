#pragma once

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "mapping/thermal_map.hpp"

namespace thermovox::test {

/// Feeds a ThermalMap and an octomap::OcTree the same returns and compares what they know.
class OctomapOracle {
 public:
  explicit OctomapOracle(const ThermalMap::Options& options) : map_(options), tree_(options.resolution) {
    tree_.setProbHit(options.occupancy.prob_hit);
    tree_.setProbMiss(options.occupancy.prob_miss);
    tree_.setClampingThresMin(options.occupancy.clamp_min);
    tree_.setClampingThresMax(options.occupancy.clamp_max);
    tree_.setOccupancyThres(options.occupancy.occupied);
  }

  [[nodiscard]] const ThermalMap& map() const { return map_; }

  /// One reading. insertPointCloud takes one origin a cloud; for returns with origins of their own its set of
  /// cells is gathered here ray by ray, in the same way.
  void integrate(std::span<const MappedReturn> reading) {
    map_.integrate(reading, Carving::octomap);
    const auto other_origin = [&](const MappedReturn& ret) {
      return ret.origin_world != reading[0].origin_world;
    };
    if (std::any_of(reading.begin(), reading.end(), other_origin)) {
      insertRayByRay(reading);
      return;
    }
    octomap::Pointcloud cloud;
    for (const MappedReturn& ret : reading) cloud.push_back(octomapPoint(ret.p_world));
    if (!reading.empty()) tree_.insertPointCloud(cloud, octomapPoint(reading[0].origin_world));
  }

  /// What the two have in common and what not.
  struct Comparison {
    std::size_t cells = 0;                ///< known to OctoMap
    std::size_t only_ours = 0;            ///< known to us alone
    std::size_t other_state = 0;          ///< occupied here, free or unknown there, or the other way round
    std::size_t other_state_clearly = 0;  ///< and the threshold is not between the log-odds here and there
    double worst_log_odds = 0.0;          ///< largest difference
  };
  [[nodiscard]] Comparison compare() {
    tree_.expand();
    Comparison result;
    for (auto leaf = tree_.begin_leafs(); leaf != tree_.end_leafs(); ++leaf) compareLeaf(leaf, result);
    const std::size_t known = knownCells();
    result.only_ours = known > result.cells ? known - result.cells : 0;
    return result;
  }

  /// At least 99.99 % of the cells that either knows have one state, with log-odds no further apart than a
  /// quantum (half of it at a clamp, the rest for what misses are rounded by).
  void expectParity() {
    const Comparison result = compare();
    EXPECT_GT(result.cells, 0U);
    EXPECT_LE(static_cast<double>(result.other_state + result.only_ours),
              1e-4 * static_cast<double>(result.cells))
        << result.other_state << " cells of another state and " << result.only_ours
        << " unknown to OctoMap, of " << result.cells;
    EXPECT_LE(result.worst_log_odds, map_.occupancyModel().quantum());
  }

 private:
  void insertRayByRay(std::span<const MappedReturn> reading) {
    octomap::KeySet free_cells, hit_cells;
    octomap::KeyRay ray;
    for (const MappedReturn& ret : reading) {
      if (tree_.computeRayKeys(octomapPoint(ret.origin_world), octomapPoint(ret.p_world), ray)) {
        free_cells.insert(ray.begin(), ray.end());
      }
      hit_cells.insert(tree_.coordToKey(octomapPoint(ret.p_world)));
    }
    for (const octomap::OcTreeKey& key : free_cells) {
      if (hit_cells.find(key) == hit_cells.end()) tree_.updateNode(key, false);
    }
    for (const octomap::OcTreeKey& key : hit_cells) tree_.updateNode(key, true);
  }

  void compareLeaf(const octomap::OcTree::leaf_iterator& leaf, Comparison& result) const {
    const octomap::OcTreeKey key = leaf.getKey();
    const CellKey cell{key[0] - kOctomapReach, key[1] - kOctomapReach, key[2] - kOctomapReach};
    const double log_odds = leaf->getLogOdds();
    const double ours = map_.logOdds(cell).value_or(log_odds);
    const double threshold = tree_.getOccupancyThresLog();
    const Occupancy state = tree_.isNodeOccupied(*leaf) ? Occupancy::occupied : Occupancy::free;
    const bool between = std::min(ours, log_odds) <= threshold && std::max(ours, log_odds) >= threshold;
    const bool same = map_.occupancy(cell) == state;
    ++result.cells;
    result.other_state += !same;
    result.other_state_clearly += !same && !between;
    result.worst_log_odds = std::max(result.worst_log_odds, std::abs(ours - log_odds));
  }

  [[nodiscard]] static octomap::point3d octomapPoint(const Eigen::Vector3d& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
  }
  [[nodiscard]] std::size_t knownCells() const {
    std::size_t known = 0;
    for (const BlockKey& key : map_.sortedBlockKeys()) {
      known += map_.block(key)->log_odds.knownCells();
    }
    return known;
  }

  ThermalMap map_;
  octomap::OcTree tree_;
};

}  // namespace thermovox::test
