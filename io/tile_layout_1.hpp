#pragma once

#include <string_view>

#include "mapping/block.hpp"
#include "mapping/tile_store.hpp"

namespace thermovox {

/// Reads the content (after decompression, from its first byte) of a tile of a station of version 1, whose
/// surface cells took 80 bytes, and brings the cells to today's quanta: means move by at most 2^-10 C, sigmas
/// by what the lower bound of today (SurfaceCell::kMinSigma) asks for, extremes by 1/32 C, stamps as
/// SurfaceCell says. Throws DataError with the fault alone, such as "it ends too early".
[[nodiscard]] TileBlocks readTileOfLayout1(const TileKey& key, std::string_view content);

}  // namespace thermovox
