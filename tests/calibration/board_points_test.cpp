#include "calibration/board_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

CalibrationBoard gridOf(CalibrationBoard::Pattern pattern, int columns, int rows) {
  CalibrationBoard board;
  board.pattern = pattern;
  board.columns = columns;
  board.rows = rows;
  board.square = 0.05;
  return board;
}

constexpr auto kChess = CalibrationBoard::Pattern::chessboard;
constexpr auto kCircles = CalibrationBoard::Pattern::asymmetric_circles;

/// Whether the points, put in this order, are the points turned about the middle.
bool isATurn(const std::vector<Eigen::Vector3d>& points, const std::vector<std::size_t>& order) {
  const auto angleOf = [](const Eigen::Vector3d& p) { return std::atan2(p.y(), p.x()); };
  const double turn = angleOf(points[order.front()]) - angleOf(points.front());
  const Eigen::Quaterniond R = expRotation({0.0, 0.0, turn});
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((points[order[i]] - R * points[i]).norm() > 1e-12) return false;
  }
  return true;
}

TEST(BoardPoints, GoRowByRowAboutTheMiddle) {
  const auto points = boardPoints(gridOf(kChess, 9, 6));
  ASSERT_EQ(points.size(), 54U);
  EXPECT_THAT(points[0], IsNear(Eigen::Vector3d(-0.20, -0.125, 0.0), 1e-15));
  EXPECT_THAT(points[1], IsNear(Eigen::Vector3d(-0.15, -0.125, 0.0), 1e-15));
  EXPECT_THAT(points[9], IsNear(Eigen::Vector3d(-0.20, -0.075, 0.0), 1e-15));
  const Eigen::Vector3d sum = std::accumulate(points.begin(), points.end(), Eigen::Vector3d(0.0, 0.0, 0.0));
  EXPECT_LT(sum.norm(), 1e-13);
}

TEST(BoardPoints, ShiftEveryOtherRowOfCirclesByHalf) {
  const auto points = boardPoints(gridOf(kCircles, 4, 11));
  ASSERT_EQ(points.size(), 44U);
  EXPECT_THAT(points[1] - points[0], IsNear(Eigen::Vector3d(0.10, 0.0, 0.0), 1e-15));
  EXPECT_THAT(points[4] - points[0], IsNear(Eigen::Vector3d(0.05, 0.05, 0.0), 1e-15));
  EXPECT_THAT(points[8] - points[0], IsNear(Eigen::Vector3d(0.0, 0.10, 0.0), 1e-15));
}

TEST(BoardPoints, LieAboutTheMiddleOfTheirExtent) {
  for (const CalibrationBoard& board :
       {gridOf(kChess, 7, 4), gridOf(kCircles, 4, 11), gridOf(kCircles, 3, 6), gridOf(kCircles, 5, 1)}) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
    for (const Eigen::Vector3d& p : boardPoints(board)) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    EXPECT_LT((low + high).norm(), 1e-13) << board.columns << " x " << board.rows;
  }
}

TEST(BoardSymmetries, AreTurnsThatTakeTheGridToItself) {
  struct Expectation {
    CalibrationBoard board;
    std::size_t ways;
  };
  for (const auto& [board, ways] :
       {Expectation{gridOf(kChess, 9, 6), 2}, Expectation{gridOf(kChess, 7, 7), 4},
        Expectation{gridOf(kCircles, 4, 11), 1}, Expectation{gridOf(kCircles, 4, 10), 2}}) {
    SCOPED_TRACE(testing::Message() << board.columns << " x " << board.rows);
    const auto points = boardPoints(board);
    const auto symmetries = boardSymmetries(board);
    ASSERT_EQ(symmetries.size(), ways);
    for (const auto& order : symmetries) EXPECT_TRUE(isATurn(points, order));
    EXPECT_TRUE(std::is_sorted(symmetries.front().begin(), symmetries.front().end()));
  }
}

TEST(BoardSymmetries, AreAllDifferent) {
  auto symmetries = boardSymmetries(gridOf(kChess, 5, 5));
  std::sort(symmetries.begin(), symmetries.end());
  EXPECT_EQ(std::unique(symmetries.begin(), symmetries.end()), symmetries.end());
}

}  // namespace
}  // namespace thermovox::test
