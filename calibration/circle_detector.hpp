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
/// first version in which OpenCV finds the grid counts (findCirclesGrid). It has to be that of a plane. The
/// covariance is not of this image but a constant, 0.05 px an axis, and contrast_sigma is 0: not measured.
/// What is found is the middle of an ellipse, which is not quite where a tilted circle's middle is seen; the
/// difference grows with the square of the circle's size. Throws ConfigError as findChessboard does.
[[nodiscard]] std::optional<std::vector<BoardCorner>> findCircles(const BoardImage& image,
                                                                  const CircleGrid& grid);

}  // namespace thermovox
