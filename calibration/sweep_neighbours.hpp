#pragma once

#include <array>
#include <span>
#include <vector>

#include "projection/laser/laser_return.hpp"

namespace thermovox {

/// The nearest return by direction to the left, above, to the right and below (each a quarter of all
/// directions); -1 where there is none within reach.
using SweepNeighbours = std::array<int, 4>;

/// Of every return of a cloud, whatever its pattern. Reach is twice the mean distance of the directions.
[[nodiscard]] std::vector<SweepNeighbours> neighboursIn(std::span<const LaserReturn> returns);

}  // namespace thermovox
