#pragma once

#include "mapping/thermal_map.hpp"
#include "projection/depth_sectors.hpp"

namespace thermovox {

/// Adds the map's surfaces (the mean point of each cell that a return hit) that may lie in the camera's view
/// to the depths of a frame: what the mission measured before is what hides things now. Cells that rays have
/// freed again do not count: what stood there has moved away.
void addSurfacesInView(const ThermalMap& map, const Pose& T_camera_world, DepthSectors& depths);

}  // namespace thermovox
