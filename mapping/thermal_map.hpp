#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "mapping/block.hpp"
#include "mapping/cell_key.hpp"
#include "mapping/occupancy_model.hpp"
#include "mapping/reading_marks.hpp"
#include "mapping/surface_cell.hpp"

namespace thermovox {

/// One laser return as the map takes it: where it lies, whence it was seen, and how warm it is.
struct MappedReturn {
  Eigen::Vector3d p_world;       ///< metres
  Eigen::Vector3d origin_world;  ///< where the laser was at that moment, metres
  Time stamp;
  std::optional<TemperatureObservation> temperature;  ///< none where no frame saw the point
};

/// Which cells a ray frees.
enum class Carving {
  none,     ///< none: surfaces only
  octomap,  ///< every cell between the laser and the return, as OctoMap's insertPointCloud does
};

/// What is known of a cell's occupancy.
enum class Occupancy { unknown, free, occupied };

/// The persistent thermal map: a block-hashed grid in the world frame with OctoMap's occupancy and, for cells
/// that a return hit, the temperature statistics. Temperature never moves geometry. Not thread-safe for
/// writing.
class ThermalMap {
 public:
  struct Options {
    double resolution = 0.05;  ///< edge of a cell, metres
    OccupancyModel::Options occupancy;
    void validate() const;  ///< throws ConfigError naming the field and its value
    friend bool operator==(const Options&, const Options&) = default;
  };

  explicit ThermalMap(const Options& options);

  /// Integrates one reading: within it a cell is updated once, hit before free (OctoMap's rule); a return
  /// without temperature still is geometry. For the map of ONE mission: what merge() added up over missions
  /// would be clamped again and guarded against the wrong statistics. Throws DataError, leaving the map as it
  /// was, when a point, an origin or a temperature is not finite or lies further out than kMaxCellKey.
  void integrate(std::span<const MappedReturn> reading, Carving carving);

  /// Adds a temperature to the surface in a cell, seen by a frame whether or not a return hit it at that
  /// moment. Where no return of this map ever hit, the surface is one that another mission's map knows: here
  /// it is then without returns and without occupancy. Throws DataError when the temperature is not finite.
  void observe(const CellKey& key, const TemperatureObservation& observation, Time stamp);

  /// Adds a map of the same resolution and occupancy model (the map of another mission): log-odds add,
  /// statistics add exactly, so that the order of missions does not matter. Throws ConfigError otherwise.
  void merge(const ThermalMap& other);

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] double resolution() const { return options_.resolution; }
  [[nodiscard]] const OccupancyModel& occupancyModel() const { return model_; }

  [[nodiscard]] CellKey keyOf(const Eigen::Vector3d& p_world) const {
    return cellKey(p_world, 1.0 / resolution());
  }
  [[nodiscard]] Eigen::Vector3d centerOf(const CellKey& key) const;
  [[nodiscard]] Occupancy occupancy(const CellKey& key) const;
  /// Log-odds of a cell (natural logarithm), clamped; nullopt where no ray ever was.
  [[nodiscard]] std::optional<double> logOdds(const CellKey& key) const;
  /// Statistics of a cell; null where no return ever hit.
  [[nodiscard]] const SurfaceCell* surface(const CellKey& key) const;

  [[nodiscard]] std::size_t blockCount() const { return blocks_.size(); }
  [[nodiscard]] std::size_t surfaceCount() const;
  [[nodiscard]] const Block* block(const BlockKey& key) const;
  /// Puts a block as it was read from a station or an OctoMap; replaces one that is there.
  void setBlock(const BlockKey& key, Block block);
  /// All blocks in ascending order of their keys (x first), so that two runs write identical files.
  [[nodiscard]] std::vector<BlockKey> sortedBlockKeys() const;
  /// Calls visit(key, block) for every block in no particular order: for results that do not depend on it.
  template <typename Visitor>
  void forEachBlock(Visitor&& visit) const {
    for (const auto& [key, block] : blocks_) visit(key, *block);
  }

 private:
  void check(std::span<const MappedReturn> reading) const;
  void updateOccupancy(std::span<const MappedReturn> reading, Carving carving);
  void updateSurfaces(std::span<const MappedReturn> reading);
  [[nodiscard]] Block& blockOrNew(const BlockKey& key);

  Options options_;
  OccupancyModel model_;
  ReadingMarks marks_;  ///< of the reading at hand; empty between readings
  std::unordered_map<BlockKey, std::unique_ptr<Block>, BlockKeyHash> blocks_;
};

/// Calls visit(key, surface_cell) for every cell that a return hit, blocks in key order, cells in index
/// order.
template <typename Visitor>
void forEachSurface(const ThermalMap& map, Visitor&& visit) {
  for (const BlockKey& block_key : map.sortedBlockKeys()) {
    const Block& block = *map.block(block_key);
    block.forEachSurface([&](int index, const SurfaceCell& cell) { visit(cellAt(block_key, index), cell); });
  }
}

}  // namespace thermovox
