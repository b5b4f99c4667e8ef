#include <zstd.h>

#include "io/tile_codec.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

using namespace thermovox;

/// What comes through is written again and must then read as the same.
void readTile(const std::string& bytes) {
  const TileKey key{-3, 0, 7};
  const TileBlocks blocks = decodeTile(key, bytes);
  const std::string again = encodeTile(blocks);
  fuzz::require(encodeTile(decodeTile(key, again)) == again);
}

/// Past the checksum, which no fuzzer guesses: the bytes as the content of a sound zstd frame.
std::string framed(const std::string& content) {
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 1);
  fuzz::require(!ZSTD_isError(size));
  packed.resize(size);
  return packed;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = fuzz::textOf(data, size);
  fuzz::read([&] { readTile(bytes); });
  fuzz::read([&] { readTile(framed(bytes)); });
  return 0;
}
