#pragma once

#include <Eigen/Core>
#include <vector>

#include "projection/calibration_board.hpp"

namespace thermovox {

/// The corners or circles of a board in its own frame (metres, z = 0), row by row: the order in which they
/// are found in an image.
[[nodiscard]] std::vector<Eigen::Vector3d> boardPoints(const CalibrationBoard& board);

/// The ways in which the board can be turned in its plane and look the same: for each of them, which of
/// boardPoints() lies where each of them lay. The first is not to turn it. Two, or four of a square grid;
/// one of circles whose rows tell up from down.
[[nodiscard]] std::vector<std::vector<std::size_t>> boardSymmetries(const CalibrationBoard& board);

}  // namespace thermovox
