#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mapping/block.hpp"

namespace thermovox {

/// Which cells one reading hit and which it saw through: two bits a cell, kept by block, so that a cell that
/// thousands of rays cross is updated once and the map is touched once a block.
class ReadingMarks {
 public:
  using Bits = CellBits;
  struct Tile {
    BlockKey key;
    Bits free{};  ///< passed by a ray; where `hit` is set too, the hit counts
    Bits hit{};
  };

  void markFree(const CellKey& key) { mark(&Tile::free, key); }
  void markHit(const CellKey& key) { mark(&Tile::hit, key); }

  /// The marked blocks in ascending order of their keys. Ends the marking until clear().
  [[nodiscard]] const std::vector<Tile>& sortedTiles();
  /// Back to nothing marked, in time proportional to what was.
  void clear();

 private:
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;

  void mark(Bits Tile::*bits, const CellKey& key) {
    const int index = indexInBlock(key);
    const BlockKey block = blockOf(key);
    if (tiles_.empty() || tiles_[last_].key != block) last_ = find(block);
    (tiles_[last_].*bits)[static_cast<std::size_t>(index >> 6)] |= std::uint64_t{1} << (index & 63);
  }
  [[nodiscard]] std::uint32_t find(const BlockKey& key);
  [[nodiscard]] std::size_t slotOf(const BlockKey& key) const;
  void grow();

  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> slots_;  ///< open addressing: indices of tiles_, a power of two of them
  std::uint32_t last_ = 0;            ///< the tile marked last: a ray stays in one for a few cells
};

}  // namespace thermovox
