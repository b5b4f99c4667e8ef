#include "mapping/reading_marks.hpp"

#include <algorithm>
#include <new>
#include <type_traits>

namespace thermovox {
namespace {

void setBit(ReadingMarks::Tile::Bits& bits, std::uint32_t cell) {
  bits[cell >> 6] |= std::uint64_t{1} << (cell & 63);
}

}  // namespace

/// From calloc: what is never marked takes no memory, for the system's zeroed pages stay shared.
ReadingMarks::TilePointer ReadingMarks::newTile() {
  static_assert(std::is_trivially_copyable_v<Tile>);
  auto* tile = static_cast<Tile*>(std::calloc(1, sizeof(Tile)));
  if (tile == nullptr) throw std::bad_alloc();
  return TilePointer(tile);
}

ReadingMarks::Tile& ReadingMarks::lookUp(const TileKey& key) {
  Tile*& tile = table_[key];
  if (tile == nullptr) {
    if (used_.size() == pool_.size()) pool_.push_back(newTile());
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
  Tile& tile = enter(place.tile);
  setBit(tile.hit, place.in_tile);
  const auto block = static_cast<std::size_t>(place.block());
  tile.hit_blocks[block / 64] |= std::uint64_t{1} << (block % 64);
}

void ReadingMarks::markBeside(const CellKey& key) {
  const CellKey beside[] = {{key.x - 1, key.y, key.z}, {key.x + 1, key.y, key.z}, {key.x, key.y - 1, key.z},
                            {key.x, key.y + 1, key.z}, {key.x, key.y, key.z - 1}, {key.x, key.y, key.z + 1}};
  for (const CellKey& cell : beside) {
    const CellPlace place = placeOf(cell);
    setBit(tileOrNew(place.tile).beside, place.in_tile);
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
  setBit(enter(first.tile).passed, first.in_tile);
  crossings.forEachChunk(codes_, [&](const RayCrossings::Codes& codes, int count) {
    markChunk(codes, count,
              [&](std::uint32_t code) { return enter(tileOfCode(code, first.tile)).passed.data(); });
  });
}

void ReadingMarks::walk(const RayCells& ray) {
  ray.forEach([this](const CellKey& key) {
    const CellPlace place = placeOf(key);
    setBit(enter(place.tile).passed, place.in_tile);
  });
}

void ReadingMarks::clear() {
  for (Tile* tile : used_) {
    slots_[slotOf(tile->key)].tile = nullptr;
    tile->entered = false;
  }
  used_.clear();
  table_.clear();
}

void ReadingMarks::keepAtMost(std::size_t bytes) {
  const std::size_t kept = std::max(bytes / sizeof(Tile), used_.size());
  if (pool_.size() > kept) pool_.resize(kept);
}

}  // namespace thermovox
