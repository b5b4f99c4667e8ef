#pragma once

#include <optional>
#include <vector>

#include "calibration/board_image.hpp"
#include "calibration/corner_refinement.hpp"

namespace thermovox {

/// An asymmetric grid of circles: every other row is shifted by half. Counted as OpenCV does, 4 x 11 is the
/// usual one.
struct CircleGrid {
  int columns = 0;  ///< circles in a row, 3 or more
  int rows = 0;     ///< 3 or more
};

/// Finds the middles of all circles of an asymmetric grid, row by row; circles may be warmer or colder than
/// the board. None where there is no whole board. With an odd number of rows the first one is always the same
/// side of the board; with an even one it may be either end.
///
/// The image is stretched, or else normalised locally by three widths (locallyNormalised), and enlarged; the
/// first version in which OpenCV finds the grid counts (findCirclesGrid). It has to be that of a plane, and
/// no circle may stand out of it. Middles are then where refineCircle() finds them in the image itself, those
/// of the circles on the board, not of the ellipses that they are seen as. Throws ConfigError as
/// findChessboard does.
[[nodiscard]] std::optional<std::vector<BoardCorner>> findCircles(const BoardImage& image,
                                                                  const CircleGrid& grid);

}  // namespace thermovox
