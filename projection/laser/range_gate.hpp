#pragma once

#include "projection/laser/laser_return.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Appends the return to the reading, or counts why not: no echo, outside [range_min, range_max], weaker than
/// min_intensity. The one gate that all kinds of laser pass. A NaN intensity is not weak: it is not known.
void appendIfValid(Reading& reading, const LaserReturn& candidate, const Laser& laser);

/// The range if it is an echo, NaN if not: drivers write 0, -1, inf or NaN where nothing came back.
[[nodiscard]] double echoOrNan(double range);

}  // namespace thermovox
