#include "io/png_counts.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <new>
#include <string_view>

#include "io/byte_order.hpp"
#include "io/pixel_claim.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using namespace std::string_view_literals;

constexpr auto kPngMagic = "\x89PNG\r\n\x1A\n"sv;

/// The header chunk of a PNG.
struct PngHeader {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  unsigned bits = 0;
  unsigned colour_type = 0;
  unsigned interlace = 0;
};

/// Of libpng's numbers: 2 is RGB, 4 grey and alpha, 6 RGB and alpha; a palette (3) counts as one.
int channelsOf(unsigned colour_type) {
  return colour_type == 2 ? 3 : colour_type == 4 ? 2 : colour_type == 6 ? 4 : 1;
}

PngHeader headerOf(std::span<const std::byte> chunk, const std::string& what) {
  const auto width = numberAt<std::uint32_t>(chunk, 0, ByteOrder::big);
  const auto height = numberAt<std::uint32_t>(chunk, 4, ByteOrder::big);
  if (!width || !height || chunk.size() < 13) throw DataError(what + " is a PNG with a damaged header");
  const auto byte = [chunk](std::size_t i) { return std::to_integer<unsigned>(chunk[i]); };
  return {*width, *height, byte(8), byte(9), byte(12)};
}

void checkHeader(const PngHeader& header, std::uint64_t packed_bytes, const std::string& what) {
  if (header.bits != 16 || header.colour_type != 0 || header.interlace != 0) {
    throw DataError(what + " is a PNG of " + std::to_string(header.width) + " x " +
                    std::to_string(header.height) + " pixels with " +
                    std::to_string(channelsOf(header.colour_type)) + " channel(s) of " +
                    std::to_string(header.bits) + " bits" + (header.interlace != 0 ? ", interlaced" : "") +
                    ", expected one channel of 16 bits");
  }
  checkClaim({header.width, header.height, 2, packed_bytes}, what);
}

struct PackedPng {
  PngHeader header;
  std::vector<std::byte> data;  ///< of all its data chunks
};

PackedPng gatherChunks(std::span<const std::byte> bytes, const std::string& what) {
  PackedPng packed;
  bool has_header = false;
  for (std::size_t place = kPngMagic.size(); place < bytes.size();) {
    const auto length = numberAt<std::uint32_t>(bytes, place, ByteOrder::big);
    if (!length || bytes.size() - place < 12 || bytes.size() - place - 12 < *length) {
      throw DataError(what + " is a PNG that is cut off after " + std::to_string(bytes.size()) + " bytes");
    }
    const std::string_view type = charactersOf(bytes.subspan(place + 4, 4));
    const auto chunk = bytes.subspan(place + 8, *length);
    if (type == "IEND") break;
    if (type == "IHDR") {
      packed.header = headerOf(chunk, what);
      has_header = true;
    } else if (type == "IDAT") {
      packed.data.insert(packed.data.end(), chunk.begin(), chunk.end());
    }
    place += std::size_t{12} + *length;
  }
  if (!has_header) throw DataError(what + " is a PNG without a header");
  return packed;
}

struct FreeDecompressor {
  void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

/// Exactly `size` bytes, or a DataError.
std::vector<std::uint8_t> inflate(const std::vector<std::byte>& packed, std::size_t size,
                                  const std::string& what) {
  const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor(
      libdeflate_alloc_decompressor());
  if (!decompressor) throw std::bad_alloc();
  std::vector<std::uint8_t> data(size);
  std::size_t written = 0;
  const libdeflate_result result = libdeflate_zlib_decompress(decompressor.get(), packed.data(),
                                                              packed.size(), data.data(), size, &written);
  if (result != LIBDEFLATE_SUCCESS || written != size) {
    throw DataError(what + " is a damaged PNG: " + std::to_string(written) +
                    " bytes come out of it, expected " + std::to_string(size));
  }
  return data;
}

/// Of left, up and corner the nearest to left + up - corner, in PNG's order of precedence.
int paeth(int left, int up, int corner) {
  const int from_left = std::abs(up - corner);
  const int from_up = std::abs(left - corner);
  const int from_corner = std::abs(left + up - 2 * corner);
  const int of_two = from_up <= from_corner ? up : corner;  // both choices without a branch
  const bool is_left = from_left <= std::min(from_up, from_corner);
  return is_left ? left : of_two;
}

/// Undoes the filter of a row in place; `above` is the row before it, already undone, or zeros. The distance
/// to the pixel on the left is two bytes.
void unfilter(unsigned filter, std::span<std::uint8_t> row, std::span<const std::uint8_t> above,
              const std::string& what) {
  const auto undo = [&](auto&& guess) {
    std::array<int, 2> left{};  // of each byte of a pixel, as the byte above it
    std::array<int, 2> corner{};
    for (std::size_t i = 0; i + 1 < row.size(); i += 2) {
      for (std::size_t byte = 0; byte < 2; ++byte) {
        const int up = above[i + byte];
        left[byte] = (row[i + byte] + guess(left[byte], up, corner[byte])) & 0xFF;
        row[i + byte] = static_cast<std::uint8_t>(left[byte]);
        corner[byte] = up;
      }
    }
  };
  switch (filter) {
    case 0:
      return;
    case 1:
      return undo([](int left, int, int) { return left; });
    case 2:
      return undo([](int, int up, int) { return up; });
    case 3:
      return undo([](int left, int up, int) { return (left + up) / 2; });
    case 4:
      return undo(paeth);
    default:
      throw DataError(what + " is a damaged PNG: a row has filter " + std::to_string(filter));
  }
}

}  // namespace

CountsPicture decodePngCounts(std::span<const std::byte> bytes, const std::string& what) {
  if (!beginsWith(bytes, kPngMagic)) throw DataError(what + " is no PNG");
  const PackedPng packed = gatherChunks(bytes, what);
  checkHeader(packed.header, packed.data.size(), what);
  const std::size_t width = packed.header.width;
  const std::size_t height = packed.header.height;
  const std::size_t stride = 1 + 2 * width;
  std::vector<std::uint8_t> data = inflate(packed.data, stride * height, what);
  CountsPicture picture{static_cast<int>(width), static_cast<int>(height),
                        std::vector<std::uint16_t>(width * height)};
  const std::vector<std::uint8_t> nothing(2 * width);
  std::span<const std::uint8_t> above = nothing;
  for (std::size_t v = 0; v < height; ++v) {
    const std::span<std::uint8_t> row(data.data() + v * stride + 1, 2 * width);
    unfilter(data[v * stride], row, above, what);
    for (std::size_t u = 0; u < width; ++u) {
      picture.counts[v * width + u] = static_cast<std::uint16_t>(row[2 * u] << 8 | row[2 * u + 1]);
    }
    above = row;
  }
  return picture;
}

}  // namespace thermovox
