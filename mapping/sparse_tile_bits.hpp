#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/block.hpp"
#include "mapping/cell_key.hpp"

namespace thermovox {

/// A bit for each cell of a tile, for marks that few of its blocks have: only these get a cache line of bits.
class SparseTileBits {
 public:
  /// Sets the bit of a cell (CellPlace::in_tile).
  void set(std::uint32_t in_tile) {
    const std::uint32_t block = in_tile / kBlockCells;
    const std::uint64_t bit = std::uint64_t{1} << (block % 64);
    if ((blocks_[block / 64] & bit) == 0) {
      blocks_[block / 64] |= bit;
      line_[block] = static_cast<std::uint16_t>(lines_.size());
      lines_.push_back({});
    }
    lines_[line_[block]][in_tile % kBlockCells / 64] |= std::uint64_t{1} << (in_tile % 64);
  }
  /// The blocks (indexInTile) with a bit, 64 to a word.
  [[nodiscard]] const std::array<std::uint64_t, kTileBlocks / 64>& blocks() const { return blocks_; }
  /// The bits of a block; null where there are none. Valid until one is set.
  [[nodiscard]] const CellBits* find(int block) const {
    const auto index = static_cast<std::size_t>(block);
    return (blocks_[index / 64] >> (index % 64) & 1) != 0 ? &lines_[line_[index]] : nullptr;
  }
  /// Memory besides the object's own.
  [[nodiscard]] std::size_t lineBytes() const { return lines_.capacity() * sizeof(CellBits); }
  /// Keeps the memory for the next bits.
  void clear() {
    blocks_.fill(0);
    lines_.clear();
  }

 private:
  std::array<std::uint64_t, kTileBlocks / 64> blocks_{};
  std::array<std::uint16_t, kTileBlocks> line_{};  ///< of the blocks with a bit
  std::vector<CellBits> lines_;
};

}  // namespace thermovox
