#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <unordered_map>
#include <vector>

#include "mapping/block.hpp"
#include "mapping/ray_crossings.hpp"
#include "mapping/sparse_tile_bits.hpp"

namespace thermovox {

/// Which cells one reading hit and which it saw through: a bit a cell, so that a cell that thousands of rays
/// cross is updated once, and the map is touched once a block. The bits lie as the map's tiles and blocks do;
/// a block's are one cache line.
class ReadingMarks {
 public:
  /// The CellBits of a tile's blocks, one after the other.
  using Bits = std::array<std::uint64_t, kTileBlocks * std::tuple_size_v<CellBits>>;
  struct Freer {
    void operator()(Bits* bits) const { std::free(bits); }
  };
  struct Tile {
    TileKey key;
    bool entered = false;  ///< hit or passed, and not only beside a hit
    /// By a ray; where `hit` is set too, the hit counts. Null where no ray was followed. Whoever reads the
    /// bits clears them.
    std::unique_ptr<Bits, Freer> passed;
    SparseTileBits hit;
    SparseTileBits beside;    ///< next to a hit; only where asked for
    std::size_t counted = 0;  ///< bytes of it in memoryBytes()

    [[nodiscard]] std::size_t memoryBytes() const {
      return sizeof(Tile) + (passed ? sizeof(Bits) : 0) + hit.lineBytes() + beside.lineBytes();
    }
  };

  void markHit(const CellPlace& place);
  /// The six cells that share a face with this one.
  void markBeside(const CellKey& key);
  /// All cells of the ray before its last one, which may be marked too: its return is a hit.
  void markPassed(const RayCells& ray);

  /// The marked tiles in the order in which they were first marked.
  [[nodiscard]] const std::vector<Tile*>& tiles() const { return used_; }
  /// The marks of a tile; null when it has none.
  [[nodiscard]] Tile* find(const TileKey& key) const;
  /// Forgets the tiles, of which nothing is marked as passed any more, and keeps the memory of some, at most
  /// kMostKept, for the next reading.
  void clear();
  static constexpr std::size_t kMostKept = 10'000'000;  ///< bytes
  /// Gives the memory of forgotten tiles beyond so many bytes back.
  void keepAtMost(std::size_t bytes);
  /// Memory of the tiles, marked or forgotten; how much the marks of the reading at hand take is known from
  /// the next clear() on.
  [[nodiscard]] std::size_t memoryBytes() const { return bytes_; }

 private:
  struct Slot {
    TileKey key;
    Tile* tile = nullptr;
  };
  static constexpr std::size_t kSlots = 4096;
  [[nodiscard]] static std::size_t slotOf(const TileKey& key) {
    return static_cast<std::size_t>((key.x & 15) | (key.y & 15) << 4 | (key.z & 15) << 8);
  }
  [[nodiscard]] Tile& tileOrNew(const TileKey& key) {
    const Slot& slot = slots_[slotOf(key)];
    return slot.tile != nullptr && slot.key == key ? *slot.tile : lookUp(key);
  }
  /// The tile, which is entered.
  [[nodiscard]] Tile& enter(const TileKey& key) {
    Tile& tile = tileOrNew(key);
    tile.entered = true;
    return tile;
  }
  /// The bits of what is passed of a tile, which is entered.
  [[nodiscard]] std::uint64_t* passedOf(const TileKey& key) {
    Tile& tile = enter(key);
    if (!tile.passed) tile.passed = newBits();
    return tile.passed->data();
  }
  [[nodiscard]] static std::unique_ptr<Bits, Freer> newBits();
  Tile& lookUp(const TileKey& key);
  void walk(const RayCells& ray);

  std::vector<Slot> slots_{kSlots};  ///< the tile looked up last of those that share a slot
  std::unordered_map<TileKey, Tile*, TileKeyHash> table_;
  std::vector<Tile*> used_;
  std::vector<std::unique_ptr<Tile>> pool_;  ///< those in use first
  std::size_t bytes_ = 0;                    ///< the sum of what is counted of them
  RayCrossings::Codes codes_;
};

}  // namespace thermovox
