#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mapping/mission_report.hpp"

namespace thermovox {

/// The frames as a station keeps them: 64 bytes each, little endian: the stamp in Unix nanoseconds (64-bit
/// integer), then T_world_camera as tx ty tz qx qy qz qw (64-bit floats).
[[nodiscard]] std::string encodeFramePoses(const std::vector<FramePose>& frames);

/// Throws DataError when the bytes are no whole rows, or a pose is none.
[[nodiscard]] std::vector<FramePose> decodeFramePoses(std::string_view bytes);

}  // namespace thermovox
