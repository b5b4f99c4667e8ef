#pragma once

#include <optional>
#include <vector>

#include "calibration/board_image.hpp"
#include "calibration/corner_refinement.hpp"

namespace thermovox {

/// The inner corners of a chessboard, where four squares meet.
struct ChessboardGrid {
  int columns = 0;  ///< 3 or more
  int rows = 0;     ///< 3 or more
};

/// Finds all inner corners of a chessboard, row by row; the first row may be any side of the board, columns
/// go to the right and rows down as one looks at it, and either squares may be the warmer ones. None where
/// there is no whole board.
///
/// The image (a large one at first reduced) is normalised locally by three widths (locallyNormalised), and
/// stretched, and enlarged; the first version in which OpenCV finds the grid counts (findChessboardCornersSB,
/// after Duda and Frese 2018; then findChessboardCorners in both polarities). It has to be the grid of a
/// plane, and its squares to alternate. Corners are then where refineCorner() finds them in the image itself;
/// a board with one that cannot be refined is none. Throws ConfigError for a grid of less than three by
/// three, and for an image without pixels or with values that are not finite.
[[nodiscard]] std::optional<std::vector<BoardCorner>> findChessboard(const BoardImage& image,
                                                                     const ChessboardGrid& grid);

}  // namespace thermovox
