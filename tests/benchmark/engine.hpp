#pragma once

#include <memory>
#include <span>

#include "mapping/thermal_map.hpp"

namespace thermovox::bench {

/// Something that builds a map of scans: the thermal map, a peer, or a lower bound.
class Engine {
 public:
  Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  virtual ~Engine() = default;

  /// Takes one scan, all of it seen from one place. Precondition: not empty.
  virtual void insert(std::span<const MappedReturn> scan) = 0;

  /// What the map holds, in cells of its resolution.
  struct Cells {
    double known = 0.0;    ///< free or occupied, or hit by a return
    double surface = 0.0;  ///< ours: that a return ever hit; peers: occupied
  };
  [[nodiscard]] virtual Cells cells() const = 0;
};

using EnginePointer = std::unique_ptr<Engine>;

/// The thermal map with its temperature statistics.
[[nodiscard]] EnginePointer thermalMapEngine(double resolution, Carving carving, int threads = 1);
/// insertPointCloud of an octomap::OcTree.
[[nodiscard]] EnginePointer octomapRays(double resolution);
/// updateNode(lazy_eval) of an octomap::OcTree for every point.
[[nodiscard]] EnginePointer octomapPoints(double resolution);
/// updateNode(lazy_eval) and averageNodeColor of an octomap::ColorOcTree for every point.
[[nodiscard]] EnginePointer colorOctomapPoints(double resolution);
/// Blocks of 8 x 8 x 8 cells in a hash table that only add up temperatures, their squares and their number:
/// what any map of blocks that keeps statistics must at least do.
[[nodiscard]] EnginePointer blockFloor(double resolution);

// Where OpenVDB is installed:

/// Cells on the rays gathered in a MaskGrid, then one update of a FloatGrid a cell.
[[nodiscard]] EnginePointer openvdbRays(double resolution);
/// One update of a FloatGrid for every point.
[[nodiscard]] EnginePointer openvdbPoints(double resolution);

}  // namespace thermovox::bench
