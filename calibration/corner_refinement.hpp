#pragma once

#include <Eigen/Core>
#include <optional>

#include "calibration/board_image.hpp"

namespace thermovox {

/// About where an inner corner of a chessboard is, and where its neighbours on the grid are from there, px.
struct CornerGuess {
  Eigen::Vector2d pixel;
  Eigen::Vector2d to_next_column;
  Eigen::Vector2d to_next_row;
};

/// An inner corner of a chessboard in an image.
struct BoardCorner {
  Eigen::Vector2d pixel;        ///< (u, v)
  Eigen::Matrix2d covariance;   ///< of the pixel, px^2, by what the image differs from the model
  double contrast_sigma = 0.0;  ///< half the difference of the squares in sigmas of the image's noise
};

/// The corner p where the image is best explained by two blurred edges that cross,
///
///   I(x) = c + g . (x - p) + A erf(n1 . (x - p) / (sqrt(2) s)) erf(n2 . (x - p) / (sqrt(2) s)),
///
/// with unit normals n1, n2 of the edges, by least squares (Levenberg and Marquardt) in a Gaussian window of
/// less than a square. `blur_px` is s: optics and pixel together. Either square may be the warmer one. None
/// where it does not converge near the guess, the window leaves the image, or nothing stands out of the noise
/// (three sigmas).
[[nodiscard]] std::optional<BoardCorner> refineCorner(const BoardImage& image, const CornerGuess& guess,
                                                      double blur_px = 0.75);

}  // namespace thermovox
