#pragma once

#include <span>
#include <string>
#include <string_view>

#include "mapping/block.hpp"
#include "mapping/tile_store.hpp"

namespace thermovox {

/// The blocks as bytes: little endian as in memory, compressed with zstd, with its checksum. Blocks
/// that compare equal give the same bytes. Precondition: all blocks lie in one tile, each once.
[[nodiscard]] std::string encodeTile(std::span<const BlockView> blocks);
[[nodiscard]] std::string encodeTile(const TileBlocks& blocks);

/// Reads what encodeTile wrote, now or in a station of version 1 or 2. Throws DataError saying what is wrong
/// with the bytes, of which nothing is trusted.
[[nodiscard]] TileBlocks decodeTile(const TileKey& key, std::string_view bytes);

}  // namespace thermovox
