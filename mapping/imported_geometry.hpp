#pragma once

#include <Eigen/Core>
#include <span>

#include "mapping/thermal_map.hpp"

namespace thermovox {

/// Adds a cloud from elsewhere (metres, world) to a map: surfaces without temperatures. A cell is hit once,
/// however many of the points lie in it, and nothing is freed: a cloud does not say whence it was seen.
/// Points that are not finite are passed over. Tiles come one after the other, so that a map with a limit of
/// its memory keeps to it. Throws DataError when none is left, or one lies further out
/// than a map reaches; the map is then as it was.
void addGeometry(std::span<const Eigen::Vector3d> points_world, ThermalMap& map);

}  // namespace thermovox
