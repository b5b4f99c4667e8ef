#pragma once

#include <span>

#include "mapping/hotspot.hpp"
#include "mapping/mission_report.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Fills in which frame saw a hot spot best, and where in it its peak is: that which sees the cell with the
/// best view from as far as this cell remembers (to 10 cm that the body may have moved, and a cell), of
/// several the nearest to it. Where the peak is outside this frame the pixel is the cell's. What stood before
/// the spot was asked when the cells took that view. Where the incidence is unknown it follows from the
/// spot's normal. Leaves everything as it is when no frame fits.
void findBestFrame(Hotspot& spot, std::span<const FramePose> frames, const ThermalCamera& camera,
                   double resolution);

}  // namespace thermovox
