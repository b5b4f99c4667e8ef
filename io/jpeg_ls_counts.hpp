#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "io/png_counts.hpp"

namespace thermovox {

/// Decodes a JPEG-LS picture (ITU-T T.87) of one channel of 9 to 16 bits, exact or nearly so. (A library
/// would do, but libcharls 2.4 never returns from some pictures that are cut off.) Throws DataError, `what`
/// first, for any other picture and a damaged one.
[[nodiscard]] CountsPicture decodeJpegLsCounts(std::span<const std::byte> bytes, const std::string& what);

}  // namespace thermovox
