#pragma once

#include <span>

#include "mapping/hotspot.hpp"
#include "mapping/mission_report.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Fills in which frame saw a hot spot best, and where in it: that which sees the spot's place from as far as
/// the cells remember their best view (to the centimetre, and a cell more), of several the nearest to it.
/// What stood before the spot was asked when the cells took that view. Where the incidence is unknown it
/// follows from the spot's normal. Leaves everything as it is when no frame fits.
void findBestFrame(Hotspot& spot, std::span<const FramePose> frames, const ThermalCamera& camera,
                   double resolution);

}  // namespace thermovox
