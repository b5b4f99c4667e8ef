#pragma once

#include <span>

#include "projection/laser/laser_return.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// One sweep of a 2D laser (Hokuyo and kin): range i lies at angle_min + i * angle_increment about +z, 0
/// along +x, counter-clockwise, and was taken at stamp + i * time_increment. Ranges in metres; inf, NaN and 0
/// are no return. With the paper's names: x = r cos(a), y = r sin(a), z = 0.
[[nodiscard]] Reading readingFromScan(Time stamp, std::span<const float> ranges, const Laser& laser);

}  // namespace thermovox
