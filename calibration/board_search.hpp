#pragma once

#include <Eigen/Core>
#include <vector>

#include "projection/calibration_board.hpp"
#include "projection/pose.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Returns of one capture that may be those of the board.
using ReturnSet = std::vector<Eigen::Vector3d>;

/// Where in a capture's returns (metres, laser frame) the board may be, without knowing where the laser is:
/// the likeliest first, at most `most`. Of a beam: where most of its readings lie. Of a scan: straight pieces
/// no longer than the board, those in front of what is beside them first. Of a cloud: flat pieces of about
/// the board's size, which ends there. A board whose plate is not known is as large as its pattern.
[[nodiscard]] std::vector<ReturnSet> boardCandidates(const ReturnSet& returns_laser, LaserKind kind,
                                                     const CalibrationBoard& board, std::size_t most = 5);

/// The returns of rays that meet the plate of a board at T_laser_board, `inset` metres from its edges, and
/// are at most `slack` metres (along the ray) off its plane.
[[nodiscard]] ReturnSet returnsOnBoard(const ReturnSet& returns_laser, const Pose& T_laser_board,
                                       const CalibrationBoard& board, double inset, double slack);

/// The size of the plate along x and y, metres: as given, or as much as the pattern covers.
[[nodiscard]] Eigen::Vector2d plateOf(const CalibrationBoard& board);

}  // namespace thermovox
