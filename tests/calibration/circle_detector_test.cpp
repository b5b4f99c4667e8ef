#include "calibration/circle_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "projection/error.hpp"
#include "tests/calibration/rendered_circles.hpp"

namespace thermovox::test {
namespace {

constexpr CircleGrid kGrid{4, 11};

RenderedCircles circlesOf(double warm, double turn_deg = 93.0, const Eigen::Vector2d& first = {135.0, 20.0}) {
  return {.pixel_from_board = homographyOf(11.0, turn_deg, first), .warm = warm};
}

/// Errors an axis, px; infinite where the board is not found in each of three images of it. The order is that
/// of the board: an odd number of rows has one only.
double rmsOf(RenderedCircles board) {
  double squares = 0.0;
  constexpr unsigned kImages = 3;
  for (board.seed = 1; board.seed <= kImages; ++board.seed) {
    const auto middles = findCircles(imageOf(board), kGrid);
    if (!middles || middles->size() != 44) return std::numeric_limits<double>::infinity();
    for (int i = 0; i < 44; ++i)
      squares += ((*middles)[static_cast<std::size_t>(i)].pixel - board.middleAt(i % 4, i / 4)).squaredNorm();
  }
  return std::sqrt(squares / (2.0 * 44.0 * kImages));
}

TEST(FindCircles, FindsBothPolarities) {
  EXPECT_LT(rmsOf(circlesOf(8.0)), 0.02);
  EXPECT_LT(rmsOf(circlesOf(-8.0)), 0.02);
  EXPECT_LT(rmsOf(circlesOf(1.5)), 0.03);
  EXPECT_LT(rmsOf(circlesOf(-1.5)), 0.03);
}

TEST(FindCircles, TellsTheFirstRowFromTheLastOne) {
  EXPECT_LT(rmsOf(circlesOf(8.0, 267.0, {25.0, 100.0})), 0.02);
}

/// A hot spot on the board, as a lamp that heats it makes one.
TEST(FindCircles, KnowsThatTiltedCirclesAreEllipses) {
  for (const double tilt_deg : {20.0, 40.0}) {
    RenderedCircles board = tiltedCircles(tilt_deg, 15.0);
    EXPECT_LT(rmsOf(board), 0.015) << tilt_deg;  // the ellipses' middles are off by 0.04 and 0.07
    board.warm = -1.5;
    EXPECT_LT(rmsOf(board), 0.03) << tilt_deg;
  }
}

TEST(FindCircles, TakesNoCirclesThatRunTogether) {
  RenderedCircles board = tiltedCircles(40.0, 15.0);
  board.radius = 0.6;
  board.warm = 1.5;
  for (board.seed = 1; board.seed <= 6; ++board.seed) {
    const auto middles = findCircles(imageOf(board), kGrid);
    if (!middles) continue;
    for (int i = 0; i < 44; ++i)
      EXPECT_LT(((*middles)[static_cast<std::size_t>(i)].pixel - board.middleAt(i % 4, i / 4)).norm(), 0.3);
  }
}

TEST(FindCircles, FindsABoardUnderALampsHotSpot) {
  const RenderedCircles board = circlesOf(1.5);
  BoardImage image = imageOf(board);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double square = (u - 90.0) * (u - 90.0) + (v - 60.0) * (v - 60.0);
      image.values[static_cast<std::size_t>(v * image.width + u)] +=
          static_cast<float>(12.0 * std::exp(-square / 1800.0));
    }
  }
  EXPECT_TRUE(findCircles(image, kGrid));
}

TEST(FindCircles, FindsSmallCircles) {
  RenderedCircles board = circlesOf(5.0);
  board.pixel_from_board = homographyOf(5.0, 80.0, {105.0, 30.0});
  EXPECT_LT(rmsOf(board), 0.04);
}

TEST(FindCircles, WithoutAWholeBoardFindsNone) {
  EXPECT_FALSE(findCircles(imageOf(circlesOf(0.0)), kGrid));
  EXPECT_FALSE(findCircles(imageOf(circlesOf(8.0, 93.0, {135.0, 75.0})), kGrid));  // the rest is below
  EXPECT_FALSE(findCircles(imageOf(circlesOf(8.0)), {5, 11}));
  const RenderedBoard chessboard{.pixel_from_board = homographyOf(9.0, 8.0, {35.0, 25.0})};
  EXPECT_FALSE(findCircles(imageOf(chessboard), kGrid));
}

TEST(FindCircles, RefusesWhatIsNoImageAndNoGrid) {
  EXPECT_THROW((void)findCircles(imageOf(circlesOf(8.0)), {2, 11}), ConfigError);
  EXPECT_THROW((void)findCircles({}, kGrid), ConfigError);
  EXPECT_THROW((void)findCircles({160, 120, {1.0F}}, kGrid), ConfigError);
}

}  // namespace
}  // namespace thermovox::test
