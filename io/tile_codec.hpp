#pragma once

#include <map>
#include <string>
#include <string_view>

#include "mapping/thermal_map.hpp"

namespace thermovox {

/// The blocks of a tile by their keys, ascending.
using TileBlocks = std::map<BlockKey, Block>;

/// The blocks as bytes: little endian whatever the machine, compressed with zstd, with its checksum. The same
/// blocks give the same bytes. Precondition: all blocks lie in the tile.
[[nodiscard]] std::string encodeTile(const TileKey& key, const TileBlocks& blocks);

/// Reads what encodeTile wrote. Throws DataError saying what is wrong with the bytes, of which nothing is
/// trusted.
[[nodiscard]] TileBlocks decodeTile(const TileKey& key, std::string_view bytes);

}  // namespace thermovox
