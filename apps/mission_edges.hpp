#pragma once

#include <cstddef>

#include "calibration/edge_alignment.hpp"
#include "io/mission_folder.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Reads a mission through and gathers what its rig can be checked by: up to 80 frames (400 for a beam)
/// spread over it, and about each the depth edges that one laser of the rig met shortly before and after.
/// `rig` says where camera and laser are; the mission's own rig how the laser's files are read. Memory is
/// that of the edges, whatever the mission's length. Precondition: the mission has frames, the rig a thermal
/// camera and that laser.
[[nodiscard]] EdgeScene gatherEdges(OpenedMission& opened, const Rig& rig, std::size_t laser);

}  // namespace thermovox
