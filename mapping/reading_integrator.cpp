#include "mapping/reading_integrator.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <tuple>
#include <utility>

#include "mapping/parallel.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kReturnsPerThread = 2000;  // fewer are not worth starting one
constexpr std::size_t kBatch = 32;               // returns whose cells are fetched together

/// Place within its cell, in edges.
Eigen::Vector3d offsetInCell(const Eigen::Vector3d& p_world, const CellKey& key, double inverse_resolution) {
  return p_world * inverse_resolution - Eigen::Vector3d(key.x, key.y, key.z);
}

/// Moves what is marked of a block into `to`. Where there is nothing no bits are written, so that pages which
/// were never marked stay the system's.
void take(ReadingMarks::Bits& tile, int block, CellBits& to) {
  std::uint64_t* from = tile.data() + static_cast<std::size_t>(block) * to.size();
  std::uint64_t all = 0;
  for (std::size_t word = 0; word < to.size(); ++word) all |= from[word];
  if (all == 0) return;
  for (std::size_t word = 0; word < to.size(); ++word) to[word] |= std::exchange(from[word], 0);
}

void join(const SparseTileBits& tile, int block, CellBits& to) {
  const CellBits* from = tile.find(block);
  if (from == nullptr) return;
  for (std::size_t word = 0; word < to.size(); ++word) to[word] |= (*from)[word];
}

void removeBits(CellBits& bits, const CellBits& a, const CellBits& b) {
  for (std::size_t word = 0; word < bits.size(); ++word) bits[word] &= ~(a[word] | b[word]);
}

void prefetch(const void* address) {
  __builtin_prefetch(address);
  __builtin_prefetch(static_cast<const char*>(address) + 56);  // what is not aligned may end on the next line
}

bool any(const CellBits& a, const CellBits& b) {
  std::uint64_t all = 0;
  for (std::size_t word = 0; word < a.size(); ++word) all |= a[word] | b[word];
  return all != 0;
}

}  // namespace

ReadingIntegrator::ReadingIntegrator(const OccupancyModel& model, double resolution)
    : steps_{.hit = static_cast<std::int8_t>(model.hit()),
             .miss = static_cast<std::int8_t>(model.miss()),
             .lowest = static_cast<std::int8_t>(model.clampMin()),
             .highest = static_cast<std::int8_t>(model.clampMax())},
      resolution_(resolution),
      marks_(1) {}

void ReadingIntegrator::setThreads(int threads) {
  threads_ = threadsToUse(threads);
}

void ReadingIntegrator::integrate(std::span<const MappedReturn> reading, Carving carving, TileTable& tiles) {
  try {
    integrateMarked(reading, carving, tiles);
  } catch (...) {
    marks_ = std::vector<ReadingMarks>(1);  // with them go bits that nobody has taken
    throw;
  }
}

void ReadingIntegrator::integrateMarked(std::span<const MappedReturn> reading, Carving carving,
                                        TileTable& tiles) {
  const std::size_t useful = 1 + reading.size() / kReturnsPerThread;
  const int workers = static_cast<int>(std::min(static_cast<std::size_t>(threads_), useful));
  if (marks_.size() < static_cast<std::size_t>(workers)) marks_.resize(static_cast<std::size_t>(workers));
  hits_.resize(reading.size());
  runInParallel(workers, [&](int worker) { mark(reading, carving, worker, workers); });
  collectTiles(tiles, workers);
  sweep(carving, workers);
  runInParallel(workers, [&](int worker) { addReturns(reading, worker, workers); });
  for (ReadingMarks& marks : marks_) marks.clear();
  std::vector<TileKey> keys;
  for (const SweptTile& swept : swept_) {
    if (swept.entered) keys.push_back(swept.key);
  }
  tiles.recount(keys);
}

std::size_t ReadingIntegrator::memoryBytes() const {
  std::size_t bytes = 0;
  for (const ReadingMarks& marks : marks_) bytes += marks.memoryBytes();
  return bytes;
}

void ReadingIntegrator::keepAtMost(std::size_t bytes) {
  for (ReadingMarks& marks : marks_) marks.keepAtMost(bytes / marks_.size());
}

void ReadingIntegrator::mark(std::span<const MappedReturn> reading, Carving carving, int worker,
                             int workers) {
  ReadingMarks& marks = marks_[static_cast<std::size_t>(worker)];
  const double inverse = 1.0 / resolution_;
  const std::size_t begin =
      reading.size() * static_cast<std::size_t>(worker) / static_cast<std::size_t>(workers);
  const std::size_t end =
      reading.size() * static_cast<std::size_t>(worker + 1) / static_cast<std::size_t>(workers);
  for (std::size_t i = begin; i < end; ++i) {
    const CellKey key = cellKey(reading[i].p_world, inverse);
    hits_[i] = placeOf(key);
    marks.markHit(hits_[i]);
    if (carving == Carving::none) continue;
    if (carving == Carving::careful) marks.markBeside(key);
    marks.markPassed(RayCells(reading[i].origin_world, reading[i].p_world, resolution_));
  }
}

void ReadingIntegrator::collectTiles(TileTable& tiles, int workers) {
  swept_.clear();
  for (int worker = 0; worker < workers; ++worker) {
    for (const ReadingMarks::Tile* tile : marks_[static_cast<std::size_t>(worker)].tiles()) {
      swept_.push_back({tile->key, tile->entered});
    }
  }
  const auto byKey = [](const SweptTile& a, const SweptTile& b) {  // of one tile what was entered comes first
    return std::tie(a.key, b.entered) < std::tie(b.key, a.entered);
  };
  std::sort(swept_.begin(), swept_.end(), byKey);
  const auto sameKey = [](const SweptTile& a, const SweptTile& b) { return a.key == b.key; };
  swept_.erase(std::unique(swept_.begin(), swept_.end(), sameKey), swept_.end());
  for (SweptTile& swept : swept_) swept.tile = swept.entered ? &tiles.findOrNew(swept.key) : nullptr;
}

void ReadingIntegrator::sweep(Carving carving, int workers) {
  std::atomic<std::size_t> next = 0;
  runInParallel(workers, [&](int) {
    for (std::size_t i = next++; i < swept_.size(); i = next++) sweepTile(swept_[i], carving);
  });
}

void ReadingIntegrator::sweepTile(const SweptTile& swept, Carving carving) {
  if (swept.tile == nullptr) return;  // only beside a hit
  std::vector<ReadingMarks::Tile*> marked;
  for (const ReadingMarks& marks : marks_) {
    if (ReadingMarks::Tile* tile = marks.find(swept.key)) marked.push_back(tile);
  }
  for (std::size_t word = 0; word < kTileBlocks / 64; ++word) {
    // Where no ray was followed, only blocks with a hit have marks.
    std::uint64_t blocks = carving == Carving::none ? 0 : ~std::uint64_t{0};
    for (const ReadingMarks::Tile* tile : marked) blocks |= tile->hit.blocks()[word];
    for (; blocks != 0; blocks &= blocks - 1) {
      sweepBlock(static_cast<int>(64 * word) + std::countr_zero(blocks), marked, carving, *swept.tile);
    }
  }
}

void ReadingIntegrator::sweepBlock(int index, std::span<ReadingMarks::Tile* const> marked, Carving carving,
                                   MapTile& tile) const {
  const bool careful = carving == Carving::careful;
  CellBits passed{}, hit{}, beside{};
  for (ReadingMarks::Tile* marks : marked) {
    if (marks->passed) take(*marks->passed, index, passed);
    join(marks->hit, index, hit);
    if (careful) join(marks->beside, index, beside);
  }
  if (!any(passed, hit)) return;
  Block& block = tile.blockOrNew(index);
  if (!block.log_odds.isNarrow()) {
    throw ConfigError("a reading came to a map that holds several missions, expected the map of one");
  }
  if (careful) removeBits(passed, beside, block.surfaceMask());
  OccupancySteps steps = steps_;
  if (careful) steps.before_hit = 0;
  updateLogOdds(block.log_odds.bytes(), passed, hit, steps);
}

void ReadingIntegrator::addReturns(std::span<const MappedReturn> reading, int worker, int workers) {
  std::array<std::pair<std::size_t, Block*>, kBatch> batch;
  std::size_t filled = 0;
  const auto addBatch = [&] {
    for (std::size_t i = 0; i < filled; ++i) {  // both lines are fetched while others are waited for
      const auto& [place, block] = batch[i];
      if (const SurfaceCell* cell = block->surface(hits_[place].inBlock())) prefetch(cell);
    }
    for (std::size_t i = 0; i < filled; ++i) {
      addReturn(reading[batch[i].first], hits_[batch[i].first], *batch[i].second);
    }
    filled = 0;
  };
  const SweptTile* swept = swept_.data();
  for (std::size_t i = 0; i < reading.size(); ++i) {
    if (swept->key != hits_[i].tile) swept = sweptTile(hits_[i].tile);
    if ((swept - swept_.data()) % workers != worker) continue;
    Block& block = swept->tile->blockOrNew(hits_[i].block());
    prefetch(&block.surfaceMask());
    if (i + kBatch < reading.size()) prefetch(&reading[i + kBatch]);
    batch[filled++] = {i, &block};
    if (filled == kBatch) addBatch();
  }
  addBatch();
}

const ReadingIntegrator::SweptTile* ReadingIntegrator::sweptTile(const TileKey& key) const {
  return &*std::lower_bound(swept_.begin(), swept_.end(), key,
                            [](const SweptTile& a, const TileKey& b) { return a.key < b; });
}

void ReadingIntegrator::addReturn(const MappedReturn& ret, const CellPlace& hit, Block& block) const {
  SurfaceCell& cell = block.surfaceOrNew(hit.inBlock());
  cell.addReturn(offsetInCell(ret.p_world, hit.key(), 1.0 / resolution_));
  if (ret.temperature) cell.addTemperature(*ret.temperature, ret.stamp);
}

}  // namespace thermovox
