#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/board_plane.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// A capture while nobody knows yet where the laser is.
struct LaserSight {
  Pose T_reference_board;
  std::vector<PlaneMoments> candidates;  ///< what in the laser's returns may be the board; may be empty
};

/// Where a laser may be.
struct LaserStart {
  Pose T_reference_laser;
  std::vector<std::optional<std::size_t>> chosen;  ///< of each capture: which candidate is the board, if any
  double cost = 0.0;                               ///< mean over the captures, 0 to 1
  /// Another answer, more than 5 degrees from this one, that explains the captures half as well or better.
  std::optional<Pose> rival;
};

/// The pose of the laser that explains most captures: candidates lie on the boards' planes, and within their
/// plates (`plate`: two sides, metres). Tried are the guess, the linear solutions of random subsets of
/// captures (planes: n . (R p + t) = d is linear in R and t; Zhang and Pless 2004 for scanners) and the 24
/// rotations along the axes, each refined robustly. A beam's roll about its axis is the guess's. None where
/// no capture has a candidate.
[[nodiscard]] std::optional<LaserStart> startLaser(const std::vector<LaserSight>& sights, LaserKind kind,
                                                   const Pose& guess, const Eigen::Vector2d& plate);

/// A beam's pose with the roll of the guess: the smallest rotation from the guess that points the same way.
[[nodiscard]] Pose withRollOf(const Pose& guess, const Pose& pose);

}  // namespace thermovox
