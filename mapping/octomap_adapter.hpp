#pragma once

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <functional>
#include <memory>

#include "mapping/thermal_map.hpp"

// The one header that speaks OctoMap; only who wants OctoMap's trees includes it.

namespace thermovox {

/// All known cells with their log-odds, pruned, inner nodes updated; thresholds and clamps are the map's.
/// Throws DataError when a cell lies beyond OctoMap's 16-bit keys (2^15 cells from the origin).
[[nodiscard]] std::unique_ptr<octomap::OcTree> toOcTree(const ThermalMap& map);

/// The occupancy of a tree as a map without temperatures. A map of one mission comes back from toOcTree bit
/// for bit, its surfaces apart, where the probabilities of its model have at most six decimals (OctoMap keeps
/// their log-odds as 32-bit floats); other trees to half a quantum, clamped to the tree's own clamps. Throws
/// DataError when a log-odds is not finite or pruned nodes of the tree stand for more than 2^32 cells, and
/// ConfigError when the tree's sensor model is none that OccupancyModel takes.
[[nodiscard]] ThermalMap fromOcTree(const octomap::OcTree& tree);

/// What a cell is to look like; 255 255 255 means "no colour" to OctoMap.
using SurfaceColor = std::function<octomap::ColorOcTreeNode::Color(const SurfaceCell&)>;

/// As toOcTree, with a colour for every cell that a return hit, its average for the nodes above them, and
/// `elsewhere` for all others: free cells, and nodes without a surface below. So no node is left without
/// colour, unless one of the given ones is 255 255 255. For show: only cells of one log-odds AND one colour
/// are pruned into one (OctoMap's own pruning would smear hot spots).
[[nodiscard]] std::unique_ptr<octomap::ColorOcTree> toColorOcTree(
    const ThermalMap& map, const SurfaceColor& color, const octomap::ColorOcTreeNode::Color& elsewhere);

}  // namespace thermovox
