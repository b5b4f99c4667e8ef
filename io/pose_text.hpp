#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "projection/pose.hpp"

namespace thermovox {

/// "tx ty tz qx qy qz qw", exact.
[[nodiscard]] std::string poseText(const Pose& pose);
/// Reads seven numbers in that order, apart by blanks or line ends; the quaternion is normalised. nullopt for
/// anything else, also when its norm is off one by more than 1 %.
[[nodiscard]] std::optional<Pose> parsePose(std::string_view text);

}  // namespace thermovox
