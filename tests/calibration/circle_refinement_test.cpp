#include "calibration/circle_refinement.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/calibration/rendered_circles.hpp"

namespace thermovox::test {
namespace {

CircleGuess guessOf(const RenderedCircles& board, int column, int row) {
  const Eigen::Vector2d beside(column % 2 == 0 ? 0.3 : -0.3, row % 2 == 0 ? -0.25 : 0.25);
  return {.pixel_from_board = board.pixel_from_board,
          .middle = {2 * column + row % 2, row},
          .radius = board.radius,
          .pixel = board.middleAt(column, row) + beside};
}

/// Errors of the refined middles of a board, sought from 0.4 px beside them.
struct Refined {
  double rms_px = 0.0;  ///< an axis
  double nees = 0.0;    ///< a degree of freedom
  std::size_t missed = 0;
};

Refined refineAll(RenderedCircles board, unsigned seeds) {
  Refined result;
  std::size_t count = 0;
  for (board.seed = 1; board.seed <= seeds; ++board.seed) {
    const BoardImage image = imageOf(board);
    for (int i = 0; i < board.columns * board.rows; ++i) {
      const int column = i % board.columns, row = i / board.columns;
      const auto corner = refineCircle(image, guessOf(board, column, row));
      if (!corner) {
        ++result.missed;
        continue;
      }
      ++count;
      const Eigen::Vector2d off = corner->pixel - board.middleAt(column, row);
      result.rms_px += off.squaredNorm() / 2.0;
      result.nees += off.dot(corner->covariance.inverse() * off) / 2.0;
    }
  }
  result.rms_px = std::sqrt(result.rms_px / static_cast<double>(count));
  result.nees /= static_cast<double>(count);
  return result;
}

RenderedCircles boardOf(double warm, double tilt_deg = 30.0) {
  RenderedCircles board = tiltedCircles(tilt_deg, 15.0);
  board.warm = warm;
  return board;
}

TEST(RefineCircle, IsWithinHundredthsOfAPixelUnderAnyTilt) {
  for (const double tilt_deg : {0.0, 45.0}) {
    const Refined strong = refineAll(boardOf(8.0, tilt_deg), 2), weak = refineAll(boardOf(-1.5, tilt_deg), 2);
    EXPECT_EQ(strong.missed + weak.missed, 0U);
    EXPECT_LT(strong.rms_px, 0.012) << tilt_deg;
    EXPECT_LT(weak.rms_px, 0.03) << tilt_deg;
  }
}

TEST(RefineCircle, SaysHowSureItIs) {
  // Noise alone, where it is so much that the model's own error (its blur is not the image's) does not count.
  RenderedCircles board = boardOf(2.0);
  board.noise = 0.15;
  const Refined noisy = refineAll(board, 6);
  EXPECT_GT(noisy.nees, 0.6);
  EXPECT_LT(noisy.nees, 1.4);
}

TEST(RefineCircle, WhereNothingIsIsNone) {
  const RenderedCircles plain = boardOf(0.0);
  const BoardImage image = imageOf(plain);
  std::size_t found = 0;
  for (int row = 0; row < plain.rows; ++row) {
    if (refineCircle(image, guessOf(plain, 1, row))) ++found;
  }
  EXPECT_LE(found, 1U);
}

TEST(RefineCircle, BesideTheImageOrWithoutACircleIsNone) {
  const RenderedCircles board = boardOf(8.0);
  const BoardImage image = imageOf(board);
  CircleGuess guess = guessOf(board, 1, 5);
  EXPECT_TRUE(refineCircle(image, guess));
  EXPECT_FALSE(refineCircle({0, 0, {}}, guess));
  guess.radius = 0.0;
  EXPECT_FALSE(refineCircle(image, guess));
  guess = guessOf(board, 1, 5);
  guess.pixel_from_board.setZero();
  EXPECT_FALSE(refineCircle(image, guess));
  guess = guessOf(board, 1, 5);
  guess.middle = {1e9, -1e9};
  EXPECT_FALSE(refineCircle(image, guess));
  guess = guessOf(board, 1, 5);
  guess.pixel = {std::numeric_limits<double>::quiet_NaN(), 60.0};
  EXPECT_FALSE(refineCircle(image, guess));
  guess.pixel = {1e15, -1e15};
  EXPECT_FALSE(refineCircle(image, guess));
  guess = guessOf(board, 0, 0);
  guess.pixel_from_board(0, 2) -= 500.0;  // all of the board is left of the image
  guess.pixel = (guess.pixel_from_board * guess.middle.homogeneous()).hnormalized();
  EXPECT_FALSE(refineCircle(image, guess));
}

}  // namespace
}  // namespace thermovox::test
