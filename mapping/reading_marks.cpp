#include "mapping/reading_marks.hpp"

#include <algorithm>
#include <new>

namespace thermovox {
namespace {

void setBit(std::uint64_t* bits, std::uint32_t cell) {
  bits[cell >> 6] |= std::uint64_t{1} << (cell & 63);
}

}  // namespace

/// From calloc: what is never marked takes no memory, for the system's zeroed pages stay shared.
std::unique_ptr<ReadingMarks::Bits, ReadingMarks::Freer> ReadingMarks::newBits() {
  auto* bits = static_cast<Bits*>(std::calloc(1, sizeof(Bits)));
  if (bits == nullptr) throw std::bad_alloc();
  return std::unique_ptr<Bits, Freer>(bits);
}

ReadingMarks::Tile& ReadingMarks::lookUp(const TileKey& key) {
  Tile*& tile = table_[key];
  if (tile == nullptr) {
    if (used_.size() == pool_.size()) {
      pool_.push_back(std::make_unique<Tile>());
      bytes_ += pool_.back()->counted = pool_.back()->memoryBytes();
    }
    tile = pool_[used_.size()].get();
    tile->key = key;
    used_.push_back(tile);
  }
  slots_[slotOf(key)] = {key, tile};
  return *tile;
}

ReadingMarks::Tile* ReadingMarks::find(const TileKey& key) const {
  const auto found = table_.find(key);
  return found == table_.end() ? nullptr : found->second;
}

void ReadingMarks::markHit(const CellPlace& place) {
  enter(place.tile).hit.set(place.in_tile);
}

void ReadingMarks::markBeside(const CellKey& key) {
  const CellKey beside[] = {{key.x - 1, key.y, key.z}, {key.x + 1, key.y, key.z}, {key.x, key.y - 1, key.z},
                            {key.x, key.y + 1, key.z}, {key.x, key.y, key.z - 1}, {key.x, key.y, key.z + 1}};
  for (const CellKey& cell : beside) {
    const CellPlace place = placeOf(cell);
    tileOrNew(place.tile).beside.set(place.in_tile);
  }
}

/// The loop of markPassed over the codes of one chunk.
template <typename TileOf>
THERMOVOX_INLINE_LOOP void markChunk(const RayCrossings::Codes& codes, int count, TileOf&& tile_of) {
  std::uint32_t tile_code = codes.tile[0];
  std::uint64_t* passed = tile_of(tile_code);
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (codes.tile[index] != tile_code) {
      tile_code = codes.tile[index];
      passed = tile_of(tile_code);
    }
    const std::uint32_t cell = codes.cell[index];
    passed[cell >> 6] |= std::uint64_t{1} << (cell & 63);
  }
}

void ReadingMarks::markPassed(const RayCells& ray) {
  if (ray.first() == ray.last()) return;
  const RayCrossings crossings(ray);
  if (crossings.isTooLong()) return walk(ray);
  const CellPlace first = placeOf(ray.first());
  setBit(passedOf(first.tile), first.in_tile);
  crossings.forEachChunk(codes_, [&](const RayCrossings::Codes& codes, int count) {
    markChunk(codes, count, [&](std::uint32_t code) { return passedOf(tileOfCode(code, first.tile)); });
  });
}

void ReadingMarks::walk(const RayCells& ray) {
  ray.forEach([this](const CellKey& key) {
    const CellPlace place = placeOf(key);
    setBit(passedOf(place.tile), place.in_tile);
  });
}

void ReadingMarks::clear() {
  for (Tile* tile : used_) {
    slots_[slotOf(tile->key)].tile = nullptr;
    tile->entered = false;
    tile->hit.clear();
    tile->beside.clear();
    bytes_ -= tile->counted;
    bytes_ += tile->counted = tile->memoryBytes();
  }
  used_.clear();
  table_.clear();
  keepAtMost(kMostKept);
}

void ReadingMarks::keepAtMost(std::size_t bytes) {
  while (bytes_ > bytes && pool_.size() > used_.size()) {
    bytes_ -= pool_.back()->counted;
    pool_.pop_back();
  }
}

}  // namespace thermovox
