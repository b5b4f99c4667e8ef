#pragma once

#include <span>
#include <vector>

#include "mapping/block_update.hpp"
#include "mapping/mapped_return.hpp"
#include "mapping/reading_marks.hpp"
#include "mapping/tile_table.hpp"

namespace thermovox {

/// Puts readings into the tiles of a map: marks what the rays of a reading hit and pass, sweeps the marks
/// over the log-odds block by block, and adds the returns to their cells. Rays are shared out among threads,
/// which mark for themselves; tiles are shared out in the sweep, which joins the marks. No cell is touched by
/// two threads, and returns come to a cell in their own order, so that the result is the same for any number.
class ReadingIntegrator {
 public:
  ReadingIntegrator(const OccupancyModel& model, double resolution);

  void setThreads(int threads);

  /// Precondition: all finite and within kMaxCellKey. Throws ConfigError when the tiles hold sums of
  /// missions, and what a store throws; the tiles may then hold a part of the reading.
  void integrate(std::span<const MappedReturn> reading, Carving carving, TileTable& tiles);

  /// Memory that is kept for the marks of the next reading.
  [[nodiscard]] std::size_t memoryBytes() const;
  /// Gives what is beyond so many bytes back.
  void keepAtMost(std::size_t bytes);

 private:
  struct SweptTile {
    TileKey key;
    bool entered = false;
    MapTile* tile = nullptr;  ///< none where the reading did not enter it
  };
  void integrateMarked(std::span<const MappedReturn> reading, Carving carving, TileTable& tiles);
  void mark(std::span<const MappedReturn> reading, Carving carving, int worker, int workers);
  void collectTiles(TileTable& tiles, int workers);
  void sweep(Carving carving, int workers);
  void sweepTile(const SweptTile& swept, Carving carving);
  void sweepBlock(int index, std::span<ReadingMarks::Tile* const> marked, Carving carving,
                  MapTile& tile) const;
  void addReturns(std::span<const MappedReturn> reading, int worker, int workers);
  void addReturn(const MappedReturn& ret, const CellPlace& hit, Block& block) const;

  [[nodiscard]] const SweptTile* sweptTile(const TileKey& key) const;

  OccupancySteps steps_;
  double resolution_;
  int threads_ = 1;
  std::vector<ReadingMarks> marks_;  ///< one a thread; empty between readings
  std::vector<CellPlace> hits_;      ///< of the reading at hand, one a return
  std::vector<SweptTile> swept_;     ///< ascending
};

}  // namespace thermovox
