#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thermovox {

/// A marker segment of a JPEG file: APP1 is 0xE1.
struct JpegSegment {
  std::uint8_t marker = 0;
  std::span<const std::byte> payload;  ///< without marker and length
};

/// The segments before the picture itself, in their order. Stops where the file is cut off or is no JPEG any
/// more; a segment that is not wholly there is left out.
[[nodiscard]] std::vector<JpegSegment> jpegSegments(std::span<const std::byte> bytes);

}  // namespace thermovox
