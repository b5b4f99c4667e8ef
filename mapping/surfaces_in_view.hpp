#pragma once

#include "mapping/thermal_map.hpp"
#include "mapping/view_cone.hpp"
#include "projection/depth_sectors.hpp"

namespace thermovox {

/// Adds the map's surfaces (the mean point of each cell that a return hit) that may lie in a camera's view
/// to the depths of a frame: what the mission measured before is what hides things now.
///
/// Cells that are free by the map's occupancy do not count. Mostly what stood there has moved away, and must
/// not hide what is behind; but OctoMap's rule also frees surfaces that many rays only graze, and these hide
/// nothing either, although they still stand.
void addSurfacesInView(const ThermalMap& map, const ViewCone& cone, DepthSectors& depths);

}  // namespace thermovox
