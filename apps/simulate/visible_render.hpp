#pragma once

#include <cstdint>
#include <vector>

#include "apps/simulate/hall.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox::simulate {

/// What a visible camera sees of the hall: panels of different grey with dark seams between them, shaded by
/// the direction of the surface and the same from everywhere. Luminance row by row, 0 where the lens has no
/// ray.
[[nodiscard]] std::vector<std::uint8_t> renderVisible(const Hall& hall, const Camera& camera,
                                                      const Pose& T_world_camera);

}  // namespace thermovox::simulate
