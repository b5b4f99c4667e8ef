#include "io/tile_codec.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "io/little_endian.hpp"
#include "io/tile_layout_1.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

// A tile, before compression: the layout's number (u8), how many blocks (u16); then, each for all blocks in
// the order of their places: the place in the tile (u16, x fastest, ascending), whether its log-odds take two
// bytes (u8), the log-odds (512 x i8, -128 unknown; or 512 x i16), a bit for each cell that holds a surface
// (8 x u64); and at last all surfaces, their first bytes, then their second bytes and so on (SurfaceCell:
// packed, little endian): alike bytes side by side are packed 40 % faster and 8 % smaller. In layout 2 cells
// had 57 bytes: all but the last, which is then 0.

constexpr std::uint8_t kLayout = 3;
constexpr std::uint8_t kShorterLayout = 2;
constexpr std::size_t kShorterCell = 57;
// Measured on the hall of tests/benchmark: 3 makes a station 3 % smaller and packs at half the speed.
constexpr int kCompressionLevel = 1;
constexpr std::size_t kPlane = kBlockCells * sizeof(std::int8_t);
constexpr std::size_t kWidePlane = kBlockCells * sizeof(LogOdds);
constexpr std::size_t kLargestSurface = 80 + 2;  // in layout 1, with its place
constexpr std::size_t kMostBytes =
    3 + kTileBlocks * (2 + 1 + kWidePlane + sizeof(CellBits) + kBlockCells * kLargestSurface);

[[noreturn]] void refuse(const TileKey& key, const std::string& fault) {
  throw DataError("tile (" + std::to_string(key.x) + ", " + std::to_string(key.y) + ", " +
                  std::to_string(key.z) + ") is damaged: " + fault);
}

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

std::string compressed(const std::string& bytes) {
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  if (!context) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kCompressionLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress2(context.get(), packed.data(), packed.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size))
    throw DataError(std::string("a tile cannot be compressed: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

std::string decompressed(const TileKey& key, std::string_view packed) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) refuse(key, "it is no zstd frame");
  if (size > kMostBytes) refuse(key, "it claims " + std::to_string(size) + " bytes");
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  if (!context) throw std::bad_alloc();
  std::string bytes(static_cast<std::size_t>(size), '\0');
  const std::size_t read =
      ZSTD_decompressDCtx(context.get(), bytes.data(), bytes.size(), packed.data(), packed.size());
  if (ZSTD_isError(read)) refuse(key, ZSTD_getErrorName(read));
  if (read != bytes.size()) refuse(key, "it is shorter than it claims");
  return bytes;
}

/// Log-odds that were summed over missions may be kept wide though each would fit a byte; files do not tell.
bool needsTwoBytes(const BlockLogOdds& log_odds) {
  if (log_odds.isNarrow()) return false;
  for (int i = 0; i < kBlockCells; ++i) {
    const LogOdds value = log_odds[i];
    if (value != kUnknown && (value <= BlockLogOdds::kUnknownByte || value > INT8_MAX)) return true;
  }
  return false;
}

void appendLogOdds(std::string& bytes, const BlockLogOdds& log_odds, bool wide) {
  if (!wide && log_odds.isNarrow()) {
    bytes.append(reinterpret_cast<const char*>(log_odds.bytes().data()), kPlane);
    return;
  }
  for (int i = 0; i < kBlockCells; ++i) {
    const LogOdds value = log_odds[i];
    if (wide) {
      appendLittleEndian(bytes, value);
    } else {
      appendLittleEndian(bytes,
                         value == kUnknown ? BlockLogOdds::kUnknownByte : static_cast<std::int8_t>(value));
    }
  }
}

/// Blocks with their places in the tile, ascending.
using OrderedBlocks = std::vector<std::pair<int, const Block*>>;

OrderedBlocks inOrder(std::span<const BlockView> blocks) {
  OrderedBlocks ordered;
  for (const BlockView& view : blocks) ordered.emplace_back(indexInTile(view.key), view.block);
  std::sort(ordered.begin(), ordered.end());
  return ordered;
}

/// Precondition: `count` is how many surfaces the blocks have together.
void appendSurfaces(std::string& bytes, const OrderedBlocks& blocks, std::size_t count) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + count * sizeof(SurfaceCell));
  std::size_t first = 0;
  for (const auto& [place, block] : blocks) {
    const std::size_t own = block->surfaceCount();
    const char* cells = reinterpret_cast<const char*>(block->surfaces().data());
    for (std::size_t byte = 0; byte < sizeof(SurfaceCell); ++byte) {
      char* alike = bytes.data() + begin + byte * count + first;
      for (std::size_t k = 0; k < own; ++k) alike[k] = cells[k * sizeof(SurfaceCell) + byte];
    }
    first += own;
  }
}

/// Takes a tile's bytes apart; whatever does not fit is refused.
class TileReader {
 public:
  TileReader(const TileKey& key, std::string_view bytes) : key_(key), reader_(bytes) {}

  TileBlocks blocks() {
    cell_bytes_ = next<std::uint8_t>() == kShorterLayout ? kShorterCell : sizeof(SurfaceCell);
    const std::size_t count = next<std::uint16_t>();
    if (count > kTileBlocks) refuse(key_, "it has too many blocks");
    const std::vector<int> places = readPlaces(count);
    const std::string_view widths = take(count);
    std::vector<Block> blocks(count);
    for (std::size_t i = 0; i < count; ++i) readLogOdds(blocks[i].log_odds, widths[i]);
    std::vector<CellBits> masks(count);
    const std::string_view packed_masks = take(count * sizeof(CellBits));
    if (count > 0) std::memcpy(masks.data(), packed_masks.data(), packed_masks.size());
    readSurfaces(blocks, masks);
    if (reader_.left() != 0) refuse(key_, "it is longer than its blocks");
    TileBlocks by_key;
    for (std::size_t i = 0; i < count; ++i) by_key.emplace(blockAt(key_, places[i]), std::move(blocks[i]));
    return by_key;
  }

 private:
  template <typename T>
  T next() {
    const std::optional<T> number = reader_.next<T>();
    if (!number) refuse(key_, "it ends too early");
    return *number;
  }
  std::string_view take(std::size_t size) {
    const std::optional<std::string_view> bytes = reader_.nextBytes(size);
    if (!bytes) refuse(key_, "it ends too early");
    return *bytes;
  }

  std::vector<int> readPlaces(std::size_t count) {
    std::vector<int> places;
    for (std::size_t i = 0; i < count; ++i) {
      const int place = next<std::uint16_t>();
      if (place >= kTileBlocks || (!places.empty() && place <= places.back()))
        refuse(key_, "its blocks are out of order");
      places.push_back(place);
    }
    return places;
  }

  void readLogOdds(BlockLogOdds& log_odds, char width) {
    if (width == 0) {
      std::memcpy(log_odds.bytes().data(), take(kPlane).data(), kPlane);
    } else if (width == 1) {
      for (int i = 0; i < kBlockCells; ++i) log_odds.set(i, next<LogOdds>());
    } else {
      refuse(key_, "the width of its log-odds is not known");
    }
  }

  void readSurfaces(std::vector<Block>& blocks, const std::vector<CellBits>& masks) {
    std::size_t count = 0;
    for (const CellBits& mask : masks) count += bitsIn(mask);
    const std::string_view bytes = take(count * cell_bytes_);
    std::size_t first = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      std::vector<SurfaceCell> surfaces(bitsIn(masks[i]));
      char* cells = reinterpret_cast<char*>(surfaces.data());
      for (std::size_t byte = 0; byte < cell_bytes_; ++byte) {
        const char* alike = bytes.data() + byte * count + first;
        for (std::size_t k = 0; k < surfaces.size(); ++k) cells[k * sizeof(SurfaceCell) + byte] = alike[k];
      }
      for (const SurfaceCell& cell : surfaces) {
        if (!cell.isPlausible()) refuse(key_, "a surface cell contradicts itself");
      }
      first += surfaces.size();
      if (!surfaces.empty()) blocks[i].setSurfaces(masks[i], std::move(surfaces));
    }
  }
  [[nodiscard]] static std::size_t bitsIn(const CellBits& mask) {
    std::size_t bits = 0;
    for (const std::uint64_t word : mask) bits += static_cast<std::size_t>(std::popcount(word));
    return bits;
  }

  TileKey key_;
  LittleEndianReader reader_;
  std::size_t cell_bytes_ = sizeof(SurfaceCell);  ///< in this layout
};

}  // namespace

std::string encodeTile(std::span<const BlockView> blocks) {
  const OrderedBlocks ordered = inOrder(blocks);
  std::size_t surfaces = 0;
  for (const auto& [place, block] : ordered) surfaces += block->surfaceCount();
  std::string bytes;
  bytes.reserve(3 + ordered.size() * (3 + kPlane + sizeof(CellBits)) + surfaces * sizeof(SurfaceCell));
  appendLittleEndian(bytes, kLayout);
  appendLittleEndian(bytes, static_cast<std::uint16_t>(ordered.size()));
  std::vector<bool> wide;
  for (const auto& [place, block] : ordered) {
    appendLittleEndian(bytes, static_cast<std::uint16_t>(place));
    wide.push_back(needsTwoBytes(block->log_odds));
  }
  for (const bool is_wide : wide) bytes.push_back(is_wide ? 1 : 0);
  for (std::size_t i = 0; i < ordered.size(); ++i) appendLogOdds(bytes, ordered[i].second->log_odds, wide[i]);
  for (const auto& [place, block] : ordered)
    bytes.append(reinterpret_cast<const char*>(block->surfaceMask().data()), sizeof(CellBits));
  appendSurfaces(bytes, ordered, surfaces);
  return compressed(bytes);
}

std::string encodeTile(const TileBlocks& blocks) {
  std::vector<BlockView> views;
  for (const auto& [block_key, block] : blocks) views.push_back({block_key, &block});
  return encodeTile(views);
}

TileBlocks decodeTile(const TileKey& key, std::string_view bytes) {
  const std::string content = decompressed(key, bytes);
  if (content.empty()) refuse(key, "it is empty");
  if (content.front() == 1) {
    try {
      return readTileOfLayout1(key, content);
    } catch (const DataError& error) {
      refuse(key, error.what());
    }
  }
  const auto layout = static_cast<std::uint8_t>(content.front());
  if (layout != kLayout && layout != kShorterLayout) refuse(key, "its layout is not known");
  return TileReader(key, content).blocks();
}

}  // namespace thermovox
