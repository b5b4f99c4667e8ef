#pragma once

#include "mapping/thermal_map.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// Adds a map after a rigid motion: T_world_map takes its coordinates to those of the result. A surface goes
/// with its statistics to the cell where the mean of its returns falls, and adds to what falls there too. A
/// cell's log-odds are those of the cell in which its centre was before. That resamples: log-odds shift by up
/// to half a cell's diagonal, surfaces that share a cell afterwards become one, and to move there and back
/// does not give the same map. Goes tile by tile: either map may have a limit of its memory, and the result
/// is the same. Throws DataError when a cell would lie further out than a map reaches (the result then holds
/// a part), ConfigError when the maps' options differ.
void addMoved(const ThermalMap& map, const Pose& T_world_map, ThermalMap& result);

}  // namespace thermovox
