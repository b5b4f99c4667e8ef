#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "mapping/block.hpp"
#include "mapping/cell_key.hpp"

namespace thermovox {

/// 8 x 8 x 8 blocks of a map, those that anything is known of: what is looked up, stored and given to another
/// thread as one.
class MapTile {
 public:
  /// By indexInTile; null where nothing is known.
  [[nodiscard]] const Block* block(int index) const { return blocks_[static_cast<std::size_t>(index)].get(); }
  [[nodiscard]] Block* block(int index) { return blocks_[static_cast<std::size_t>(index)].get(); }
  Block& blockOrNew(int index) {
    std::unique_ptr<Block>& block = blocks_[static_cast<std::size_t>(index)];
    if (!block) block = std::make_unique<Block>();
    return *block;
  }

  /// Calls visit(index, block) in ascending order.
  template <typename Visitor>
  void forEachBlock(Visitor&& visit) const {
    for (int index = 0; index < kTileBlocks; ++index) {
      if (const Block* found = block(index)) visit(index, *found);
    }
  }
  [[nodiscard]] std::size_t memoryBytes() const {
    std::size_t bytes = sizeof(MapTile);
    forEachBlock([&](int, const Block& block) { bytes += block.memoryBytes(); });
    return bytes;
  }

 private:
  std::array<std::unique_ptr<Block>, kTileBlocks> blocks_;
};

}  // namespace thermovox
