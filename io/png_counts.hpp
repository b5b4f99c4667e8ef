#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thermovox {

/// A picture of one channel of 16 bits, row by row.
struct CountsPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> counts;
};

/// Decodes a PNG of one grey channel of 16 bits, not interlaced, as PNG stores it: the first byte of a sample
/// is the most significant one. (A library would do, but libpng and OpenCV print what they do not like.)
/// Throws DataError, `what` first, for any other picture and a damaged one.
[[nodiscard]] CountsPicture decodePngCounts(std::span<const std::byte> bytes, const std::string& what);

}  // namespace thermovox
