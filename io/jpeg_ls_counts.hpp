#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "io/png_counts.hpp"

namespace thermovox {

/// Decodes a JPEG-LS picture of one channel of 9 to 16 bits. Throws DataError, `what` first, for any other
/// picture and a damaged one.
[[nodiscard]] CountsPicture decodeJpegLsCounts(std::span<const std::byte> bytes, const std::string& what);

}  // namespace thermovox
