#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "projection/time.hpp"

namespace thermovox {

/// One echo of a laser beam, of whatever kind of laser.
struct LaserReturn {
  Time stamp;               ///< of this very echo
  Eigen::Vector3d p_laser;  ///< metres, laser frame: x forward, y left, z up
  float intensity = std::numeric_limits<float>::quiet_NaN();  ///< NaN where the laser does not say

  /// The laser's own reading, metres (D of the paper's equation 10).
  [[nodiscard]] double range() const { return p_laser.norm(); }
};

/// What was left out while returns were made, by reason.
struct DroppedReturns {
  std::size_t no_return = 0;  ///< NaN, infinite or zero: the beam came back from nothing
  std::size_t too_near = 0;   ///< under range_min
  std::size_t too_far = 0;    ///< over range_max
  std::size_t too_weak = 0;   ///< under min_intensity
  std::size_t bad_time = 0;   ///< a time of its own that is not finite or far from its sweep's

  [[nodiscard]] std::size_t total() const { return no_return + too_near + too_far + too_weak + bad_time; }
  DroppedReturns& operator+=(const DroppedReturns& other) {
    no_return += other.no_return;
    too_near += other.too_near;
    too_far += other.too_far;
    too_weak += other.too_weak;
    bad_time += other.bad_time;
    return *this;
  }
};

/// One sweep of a laser: a single range of a beam, a line of a scanner, a cloud. The unit in which the map
/// integrates, whatever the laser.
struct Reading {
  Time stamp;                        ///< of the sweep's start
  std::size_t laser = 0;             ///< which of the rig's lasers
  std::vector<LaserReturn> returns;  ///< in the order of the file
  DroppedReturns dropped;
};

}  // namespace thermovox
