#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mapping/block.hpp"
#include "mapping/cell_key.hpp"
#include "mapping/mapped_return.hpp"
#include "mapping/occupancy_model.hpp"
#include "mapping/reading_integrator.hpp"
#include "mapping/tile_table.hpp"

namespace thermovox {

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

  /// How many threads integrate() may use (0: one a processor); 1 at first. The result is always the same.
  void setThreads(int threads) { integrator_.setThreads(threads); }
  /// From now on integrate(), observe(), setBlock(), mergeBlock() and merge() put tiles into the store when
  /// the map takes more memory than the limit; all queries bring back what they need. While a reading is
  /// integrated, its own marks and tiles come on top. The store must outlive the map.
  void spillTo(TileStore& store, std::size_t limit_bytes);

  /// Throws the DataError that integrate() would.
  void check(std::span<const MappedReturn> reading) const;
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
  /// Statistics of a cell; null where no return hit and no frame painted.
  [[nodiscard]] const SurfaceCell* surface(const CellKey& key) const;

  [[nodiscard]] std::size_t blockCount() const;
  [[nodiscard]] std::size_t surfaceCount() const;
  /// Memory of what is not in the store, and of what is kept for the next reading.
  [[nodiscard]] std::size_t memoryBytes() const;
  /// Tiles that have gone to the store so far.
  [[nodiscard]] std::size_t spilledTiles() const { return tiles_.spills(); }
  /// Null where nothing is known. Valid until the map changes.
  [[nodiscard]] const Block* block(const BlockKey& key) const;
  /// Puts a block as it was read from a station or an OctoMap; replaces one that is there.
  void setBlock(const BlockKey& key, Block block);
  /// Adds a block as merge() does.
  void mergeBlock(const BlockKey& key, const Block& block);
  /// All blocks in ascending order of their keys (x first), so that two runs write identical files.
  [[nodiscard]] std::vector<BlockKey> sortedBlockKeys() const;

  [[nodiscard]] std::vector<TileKey> sortedTileKeys() const { return tiles_.sortedKeys(); }
  /// A tile, also one in the store, where it stays. Null where nothing is known; valid until the map changes.
  [[nodiscard]] std::shared_ptr<const MapTile> tile(const TileKey& key) const { return tiles_.look(key); }
  /// Calls visit(key, tile) for every tile in ascending order of the keys.
  template <typename Visitor>
  void forEachTile(Visitor&& visit) const {
    tiles_.forEachSorted(visit);
  }
  /// Calls visit(key, block) for every block in no particular order: for results that do not depend on it.
  /// The visitor must not ask the map for other cells.
  template <typename Visitor>
  void forEachBlock(Visitor&& visit) const {
    forEachBlockOfTiles([](const TileKey&) { return true; }, visit);
  }
  /// The same for the tiles that keep(tile_key) lets pass.
  template <typename Keep, typename Visitor>
  void forEachBlockOfTiles(Keep&& keep, Visitor&& visit) const {
    tiles_.forEach(keep, [&](const TileKey& tile_key, const MapTile& tile) {
      tile.forEachBlock([&](int index, const Block& block) { visit(blockAt(tile_key, index), block); });
    });
  }

 private:
  /// What is kept for the marks of the next reading: a quarter of the memory at most, where that has a limit.
  void keepFewMarks();
  void trim() { tiles_.trim(integrator_.memoryBytes()); }
  [[nodiscard]] LogOdds logOddsOf(const CellKey& key) const;

  Options options_;
  OccupancyModel model_;
  ReadingIntegrator integrator_;
  TileTable tiles_;
};

/// Calls visit(key, surface_cell) for every cell with surface statistics: tiles in ascending order of their
/// keys, within them blocks and cells with x running fastest.
template <typename Visitor>
void forEachSurface(const ThermalMap& map, Visitor&& visit) {
  map.forEachTile([&](const TileKey& tile_key, const MapTile& tile) {
    tile.forEachBlock([&](int block_index, const Block& block) {
      block.forEachSurface([&](int index, const SurfaceCell& cell) {
        visit(cellAt(blockAt(tile_key, block_index), index), cell);
      });
    });
  });
}

}  // namespace thermovox
