#include "io/jpeg_segments.hpp"

#include "io/byte_order.hpp"

namespace thermovox {
namespace {

constexpr std::uint8_t kStartOfScan = 0xDA;
constexpr std::uint8_t kEndOfImage = 0xD9;

/// Markers that stand alone: restarts, start of image, and the temporary one of arithmetic coding.
bool hasNoLength(std::uint8_t marker) {
  return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
}

}  // namespace

std::vector<JpegSegment> jpegSegments(std::span<const std::byte> bytes) {
  std::vector<JpegSegment> segments;
  std::size_t place = 0;
  while (place + 2 <= bytes.size() && bytes[place] == std::byte{0xFF}) {
    const auto marker = std::to_integer<std::uint8_t>(bytes[place + 1]);
    if (marker == 0xFF) {  // fill bytes may stand before a marker
      ++place;
      continue;
    }
    place += 2;
    if (hasNoLength(marker)) continue;
    if (marker == kStartOfScan || marker == kEndOfImage) break;
    const auto length = numberAt<std::uint16_t>(bytes, place, ByteOrder::big);
    if (!length || *length < 2 || bytes.size() - place < *length) break;
    segments.push_back({marker, bytes.subspan(place + 2, *length - 2U)});
    place += *length;
  }
  return segments;
}

}  // namespace thermovox
