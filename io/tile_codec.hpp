#pragma once

#include <map>
#include <string>
#include <string_view>

#include "mapping/thermal_map.hpp"

namespace thermovox {

/// A station keeps its map in tiles of 8 x 8 x 8 blocks, by the blocks' keys divided by 8, rounded down.
inline constexpr int kTileBits = 3;
inline constexpr int kTileEdge = 1 << kTileBits;

struct TileKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  friend auto operator<=>(const TileKey&, const TileKey&) = default;
};
[[nodiscard]] inline TileKey tileOf(const BlockKey& key) {
  return {key.x >> kTileBits, key.y >> kTileBits, key.z >> kTileBits};
}

/// The blocks of a tile by their keys, ascending.
using TileBlocks = std::map<BlockKey, Block>;

/// The blocks as bytes: little endian whatever the machine, compressed with zstd, with its checksum. The same
/// blocks give the same bytes. Precondition: all blocks lie in the tile.
[[nodiscard]] std::string encodeTile(const TileKey& key, const TileBlocks& blocks);

/// Reads what encodeTile wrote. Throws DataError saying what is wrong with the bytes, of which nothing is
/// trusted.
[[nodiscard]] TileBlocks decodeTile(const TileKey& key, std::string_view bytes);

}  // namespace thermovox
