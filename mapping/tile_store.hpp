#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "mapping/block.hpp"
#include "mapping/cell_key.hpp"
#include "mapping/map_tile.hpp"

namespace thermovox {

/// The blocks of a tile by their keys, ascending.
using TileBlocks = std::map<BlockKey, Block>;

/// A block in the memory of somebody else.
struct BlockView {
  BlockKey key;
  const Block* block = nullptr;
};

/// The blocks of a tile where they are, in no particular order.
[[nodiscard]] std::vector<BlockView> viewsOf(const TileKey& key, const MapTile& tile);

/// Where a map that outgrows its memory keeps tiles that it does not need for now. A tile is in the store or
/// in the map, never in both with different content: who puts a tile drops it, who takes it owns it. Not
/// thread-safe. The functions that touch the disk throw DataError saying what cannot be written or read.
class TileStore {
 public:
  virtual ~TileStore() = default;

  /// Keeps the blocks under the tile's key, in place of what is there. Precondition: all lie in the tile,
  /// each once.
  virtual void put(const TileKey& tile, std::span<const BlockView> blocks) = 0;
  /// Gives the tile back and forgets it; nullopt when it is not there.
  [[nodiscard]] virtual std::optional<TileBlocks> take(const TileKey& tile) = 0;
  /// The tile, which stays; nullopt when it is not there.
  [[nodiscard]] virtual std::optional<TileBlocks> get(const TileKey& tile) const = 0;
  [[nodiscard]] virtual bool holds(const TileKey& tile) const = 0;
  /// All tiles in the store, ascending.
  [[nodiscard]] virtual std::vector<TileKey> sortedTiles() const = 0;

 protected:
  TileStore() = default;
  TileStore(const TileStore&) = default;
  TileStore& operator=(const TileStore&) = default;
};

}  // namespace thermovox
