#pragma once

#include <cstdint>

#include "apps/simulate/hall.hpp"

namespace thermovox::simulate {

/// Half the width of the aisle along x that every layout keeps free, metres.
inline constexpr double kAisleHalfWidth = 1.4;
/// No object ends under this height, so that a flight below sees no tops, metres.
inline constexpr double kLowestTop = 2.45;

/// A converter hall: cabinets with bushings on top and valve towers of stacked modules in two rows, posts in
/// front of them, bus ducts overhead, and hot joints where the aisle sees them. Same seed, same hall.
[[nodiscard]] Hall makeHall(std::uint64_t seed);

}  // namespace thermovox::simulate
