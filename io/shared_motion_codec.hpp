#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mapping/shared_errors.hpp"

namespace thermovox {

/// The rows as a station keeps them: 128 bytes each, little endian: cube x y z, laser, count (32-bit
/// integers), then by_rotation and by_translation row by row, by_range, lever and view (32-bit floats).
[[nodiscard]] std::string encodeSharedMotions(const std::vector<SharedMotion>& motions);

/// Throws DataError when the bytes are no whole rows, a count is 0, or a number is not finite.
[[nodiscard]] std::vector<SharedMotion> decodeSharedMotions(std::string_view bytes);

}  // namespace thermovox
