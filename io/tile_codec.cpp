#include "io/tile_codec.hpp"

#include <zstd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

#include "io/little_endian.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

// A tile, before compression: the layout's number (u8), how many blocks (u16), and for each its place in the
// tile (u16, x fastest, ascending), 512 log-odds (i16), a bit for each cell that holds a surface (8 x u64),
// and the surfaces in the order of their cells as they lie in memory (SurfaceCell, packed, little endian).

constexpr std::uint8_t kLayout = 2;
constexpr int kCompressionLevel = 3;
constexpr std::size_t kSurfaceBytes = sizeof(SurfaceCell);
constexpr std::size_t kMostBytes = 3 + kTileBlocks * (4 + kBlockCells * (2 + 1 + kSurfaceBytes));

struct FreeCompressor {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

void appendBlock(std::string& bytes, int place, const Block& block) {
  appendLittleEndian(bytes, static_cast<std::uint16_t>(place));
  for (int i = 0; i < kBlockCells; ++i) appendLittleEndian(bytes, block.log_odds[i]);
  for (const std::uint64_t word : block.surfaceMask()) appendLittleEndian(bytes, word);
  const std::span<const SurfaceCell> surfaces = block.surfaces();
  bytes.append(reinterpret_cast<const char*>(surfaces.data()), surfaces.size_bytes());
}

[[noreturn]] void refuse(const TileKey& key, const std::string& fault) {
  throw DataError("tile (" + std::to_string(key.x) + ", " + std::to_string(key.y) + ", " +
                  std::to_string(key.z) + ") is damaged: " + fault);
}

std::string compressed(const std::string& bytes) {
  const std::unique_ptr<ZSTD_CCtx, FreeCompressor> context(ZSTD_createCCtx());
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
  std::string bytes(static_cast<std::size_t>(size), '\0');
  const std::size_t read = ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (ZSTD_isError(read)) refuse(key, ZSTD_getErrorName(read));
  if (read != bytes.size()) refuse(key, "it is shorter than it claims");
  return bytes;
}

/// Takes a tile's bytes apart; whatever does not fit is refused.
class TileReader {
 public:
  TileReader(const TileKey& key, std::string_view bytes) : key_(key), reader_(bytes) {}

  TileBlocks blocks() {
    if (next<std::uint8_t>() != kLayout) refuse(key_, "its layout is not known");
    const int count = countUpTo(next<std::uint16_t>(), kTileBlocks, "blocks");
    TileBlocks blocks;
    int last_place = -1;
    for (int i = 0; i < count; ++i) {
      last_place = ascending(last_place, kTileBlocks, "blocks");
      blocks.emplace(blockAt(key_, last_place), block());
    }
    if (reader_.left() != 0) refuse(key_, "it is longer than its blocks");
    return blocks;
  }

 private:
  template <typename T>
  T next() {
    const std::optional<T> number = reader_.next<T>();
    if (!number) refuse(key_, "it ends too early");
    return *number;
  }
  template <typename T>
  void fill(T& numbers) {
    for (auto& number : numbers) number = next<std::remove_reference_t<decltype(number)>>();
  }
  int countUpTo(int count, int most, const char* what) {
    if (count > most) refuse(key_, std::string("it has too many ") + what);
    return count;
  }
  int ascending(int last, int limit, const char* what) {
    const int place = next<std::uint16_t>();
    if (place <= last || place >= limit) refuse(key_, std::string("its ") + what + " are out of order");
    return place;
  }

  Block block() {
    Block block;
    for (int i = 0; i < kBlockCells; ++i) block.log_odds.set(i, next<LogOdds>());
    CellBits mask{};
    fill(mask);
    int count = 0;
    for (const std::uint64_t word : mask) count += std::popcount(word);
    std::vector<SurfaceCell> surfaces(static_cast<std::size_t>(count));
    const auto packed = reader_.nextBytes(surfaces.size() * sizeof(SurfaceCell));
    if (!packed) refuse(key_, "it ends too early");
    std::memcpy(surfaces.data(), packed->data(), packed->size());
    for (const SurfaceCell& cell : surfaces) {
      if (!cell.isPlausible()) refuse(key_, "a surface cell contradicts itself");
    }
    block.setSurfaces(mask, std::move(surfaces));
    return block;
  }

  TileKey key_;
  LittleEndianReader reader_;
};

}  // namespace

std::string encodeTile(const TileKey& key, const TileBlocks& blocks) {
  std::string bytes;
  appendLittleEndian(bytes, kLayout);
  appendLittleEndian(bytes, static_cast<std::uint16_t>(blocks.size()));
  for (int place = 0; place < kTileBlocks; ++place) {
    const auto found = blocks.find(blockAt(key, place));
    if (found != blocks.end()) appendBlock(bytes, place, found->second);
  }
  return compressed(bytes);
}

TileBlocks decodeTile(const TileKey& key, std::string_view bytes) {
  const std::string content = decompressed(key, bytes);
  return TileReader(key, content).blocks();
}

}  // namespace thermovox
