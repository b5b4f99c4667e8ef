#include "calibration/corner_refinement.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "tests/calibration/rendered_board.hpp"

namespace thermovox::test {
namespace {

/// Errors of the refined corners of a board, sought from 0.4 px beside them.
struct Refined {
  double rms_px = 0.0;  ///< an axis
  double nees = 0.0;    ///< a degree of freedom
  std::size_t missed = 0;
};

Refined refineAll(RenderedBoard board, unsigned seeds) {
  Refined result;
  std::size_t count = 0;
  for (board.seed = 1; board.seed <= seeds; ++board.seed) {
    const BoardImage image = imageOf(board);
    for (int row = 0; row < board.rows; ++row) {
      for (int column = 0; column < board.columns; ++column) {
        const Eigen::Vector2d truth = board.cornerAt(column, row);
        const Eigen::Vector2d start =
            truth + Eigen::Vector2d(column % 2 == 0 ? 0.3 : -0.3, row % 2 == 0 ? -0.25 : 0.25);
        const auto corner = refineCorner(
            image, {start, board.cornerAt(column + 1, row) - truth, board.cornerAt(column, row + 1) - truth});
        if (!corner) {
          ++result.missed;
          continue;
        }
        ++count;
        const Eigen::Vector2d off = corner->pixel - truth;
        result.rms_px += off.squaredNorm() / 2.0;
        result.nees += off.dot(corner->covariance.inverse() * off) / 2.0;
      }
    }
  }
  result.rms_px = std::sqrt(result.rms_px / static_cast<double>(count));
  result.nees /= static_cast<double>(count);
  return result;
}

/// A board whose squares are 10 px wide, turned so that no edge runs along the pixels.
RenderedBoard boardOf(double warm) {
  return {.pixel_from_board = homographyOf(10.0, 12.0, {42.3, 25.7}, {0.004, -0.003}), .warm = warm};
}

TEST(RefineCorner, IsWithinHundredthsOfAPixel) {
  const Refined strong = refineAll(boardOf(8.0), 4), weak = refineAll(boardOf(2.0), 4);
  EXPECT_EQ(strong.missed, 0U);
  EXPECT_EQ(weak.missed, 0U);
  EXPECT_LT(strong.rms_px, 0.01);
  EXPECT_LT(weak.rms_px, 0.02);
}

TEST(RefineCorner, SeesEitherPolarity) {
  EXPECT_LT(refineAll(boardOf(-8.0), 2).rms_px, 0.01);
}

TEST(RefineCorner, SaysHowSureItIs) {
  // Noise alone, where it is so much that the model's own error does not count.
  RenderedBoard board = boardOf(2.0);
  board.noise = 0.15;
  const Refined noisy = refineAll(board, 8);
  EXPECT_GT(noisy.nees, 0.6);
  EXPECT_LT(noisy.nees, 1.6);
}

TEST(RefineCorner, WhereNothingIsIsNone) {
  RenderedBoard plain = boardOf(0.0);
  const BoardImage image = imageOf(plain);
  std::size_t found = 0;
  for (int column = 0; column < 9; ++column) {
    const Eigen::Vector2d at = plain.cornerAt(column, 3);
    if (refineCorner(image, {at, {10.0, 0.0}, {0.0, 10.0}})) ++found;
  }
  EXPECT_LE(found, 1U);
}

TEST(RefineCorner, BesideTheImageOrWithoutAGridIsNone) {
  const BoardImage image = imageOf(boardOf(8.0));
  const Eigen::Vector2d right(10.0, 0.0), down(0.0, 10.0);
  EXPECT_FALSE(refineCorner(image, {{3.0, 60.0}, right, down}));
  EXPECT_FALSE(refineCorner(image, {{-40.0, 1e9}, right, down}));
  EXPECT_FALSE(refineCorner(image, {{80.0, 60.0}, {0.0, 0.0}, down}));
  EXPECT_FALSE(refineCorner(image, {{std::numeric_limits<double>::quiet_NaN(), 60.0}, right, down}));
  EXPECT_FALSE(refineCorner({0, 0, {}}, {{0.0, 0.0}, right, down}));
}

}  // namespace
}  // namespace thermovox::test
