#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "projection/trajectory.hpp"

namespace thermovox {

/// Reads poses T_world_body in the TUM format: `timestamp tx ty tz qx qy qz qw` separated by blanks, seconds
/// and metres; lines that begin with '#' are comments. Quaternions whose norm is off by at most 1 % are
/// normalised. Throws DataError naming file and line: another number of columns, a number that is not finite,
/// a norm off by more, stamps that do not ascend, or no pose at all.
[[nodiscard]] std::vector<StampedPose> readTumTrajectory(const std::filesystem::path& file);

/// The same from a stream; `name` stands for it in messages.
[[nodiscard]] std::vector<StampedPose> readTumTrajectory(std::istream& stream, const std::string& name);

}  // namespace thermovox
