#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "projection/laser/laser_return.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Where a laser's reading falls off the edge of something: the last return on the nearer surface, and the
/// first beam that passes it. The edge lies between the two beams, as far out as the nearer surface.
struct DepthEdge {
  Time near_stamp;
  Time past_stamp;
  Eigen::Vector3d near_laser;  ///< the return on the nearer surface, metres, laser frame
  Eigen::Vector3d past_laser;  ///< on the beam past the edge, at the range of the nearer return
};

/// Edges between neighbours of one sweep: of a scan along it, of a cloud in four directions about each
/// return. A slanted surface is no edge: the range has to jump by 0.25 m, 5 % of it, and four times what it
/// changes by on the nearer surface.
[[nodiscard]] std::vector<DepthEdge> edgesWithin(const Reading& sweep, const Laser& laser);

/// Edges between two successive sweeps of a scan: between returns of the same angle.
[[nodiscard]] std::vector<DepthEdge> edgesBetween(const Reading& earlier, const Reading& later,
                                                  const Laser& laser);

/// Edges along the track of a beam: between successive returns.
[[nodiscard]] std::vector<DepthEdge> edgesAlong(std::span<const LaserReturn> track);

}  // namespace thermovox
