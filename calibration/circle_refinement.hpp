#pragma once

#include <Eigen/Core>
#include <optional>

#include "calibration/board_image.hpp"
#include "calibration/corner_refinement.hpp"

namespace thermovox {

/// A circle on an asymmetric grid, lengths on the board in half distances of neighbours in a row, and about
/// where it is seen.
struct CircleGuess {
  Eigen::Matrix3d pixel_from_board;  ///< the homography of the whole board
  Eigen::Vector2d middle;            ///< on the board
  double radius = 0.0;               ///< on the board
  Eigen::Vector2d pixel;             ///< where its middle is seen, (u, v)
};

/// The pixel p that a circle's middle is seen at, where the image is best explained by a blurred disc,
///
///   I(x) = c + g . (x - p) + A (1 + erf(t(x) / (sqrt(2) s))) / 2,
///
/// with t the distance of x inside the circle's outline, px: the ellipse that the homography makes of it,
/// moved to p. By least squares (Gauss and Newton) over the part of the image that is nearer to this circle
/// than to its neighbours. `blur_px` is s: optics and pixel together. The circle may be warmer or colder than
/// the board. None where it does not converge near the guess, leaves the image, or does not stand out of the
/// noise (three sigmas).
[[nodiscard]] std::optional<BoardCorner> refineCircle(const BoardImage& image, const CircleGuess& guess,
                                                      double blur_px = 0.75);

}  // namespace thermovox
