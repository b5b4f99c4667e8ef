#pragma once

#include <vector>

#include "calibration/board_search.hpp"
#include "calibration/edge_residual.hpp"

namespace thermovox {

/// Where the returns of one capture (metres, laser frame) pass an edge of the plate at T_laser_board: between
/// a return from the board, `range_sigma` exact, and its neighbour from something behind it. Of a scan the
/// neighbours in angle; of a cloud pairs that are each other's nearest; of a beam one crossing where its
/// readings jump between board and background, as if it were set upon the edge. A crossing counts only where
/// one edge is nearest without doubt. Crossings are sorted by the side they are of; how much of their errors
/// a side has in common tells how little they scatter: less than gaps that are met anywhere would. None where
/// the plate's size is not known.
[[nodiscard]] std::vector<EdgeSide> edgeSides(const ReturnSet& returns_laser, LaserKind kind,
                                              const Pose& T_laser_board, const CalibrationBoard& board,
                                              double range_sigma);

}  // namespace thermovox
