#include "calibration/board_search.hpp"

#include <gtest/gtest.h>

#include "calibration/cloud_board.hpp"
#include "calibration/scan_board.hpp"
#include "tests/calibration/calibration_scene.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

ReturnSet readingsAt(double range, std::size_t count, Chance& chance) {
  ReturnSet readings;
  for (std::size_t i = 0; i < count; ++i) readings.emplace_back(range + chance.normal(0.005), 0.0, 0.0);
  return readings;
}

void append(ReturnSet& to, const ReturnSet& more) {
  to.insert(to.end(), more.begin(), more.end());
}

TEST(PlateOf, IsAsGivenOrWhatThePatternCovers) {
  CalibrationBoard board = plate();
  EXPECT_THAT(plateOf(board), IsNear(Eigen::Vector2d(0.60, 0.42), 1e-15));
  board.width = board.height = 0.0;  // 9 x 6 squares
  EXPECT_THAT(plateOf(board), IsNear(Eigen::Vector2d(0.54, 0.36), 1e-15));
  board.height = 0.5;
  EXPECT_THAT(plateOf(board), IsNear(Eigen::Vector2d(0.54, 0.5), 1e-15));
  CalibrationBoard circles;
  circles.pattern = CalibrationBoard::Pattern::asymmetric_circles;
  circles.columns = 4;
  circles.rows = 11;
  circles.square = 0.04;
  EXPECT_THAT(plateOf(circles), IsNear(Eigen::Vector2d(0.28, 0.40), 1e-15));
}

TEST(ReturnsOnBoard, AreThoseOfRaysThatMeetThePlate) {
  Chance chance(1);
  const CalibrationBoard board = plate();
  for (const Pose& T_reference_board : boardsHeld(10, 1)) {
    const Pose T_laser_board = laserBesideCamera().inverse() * T_reference_board;
    for (const LaserKind kind : {LaserKind::scan, LaserKind::cloud}) {
      const ReturnSet all = returnsOf(raysOf(kind), T_laser_board, board, {0.004, 0.0}, chance);
      std::size_t expected = 0;
      for (const Eigen::Vector3d& p : all)
        expected += rangeOfPlate(p.normalized(), T_laser_board, board) ? 1 : 0;
      const ReturnSet kept = returnsOnBoard(all, T_laser_board, board, 0.0, 0.03);  // 7.5 sigmas
      EXPECT_EQ(kept.size(), expected);
      EXPECT_LT(returnsOnBoard(all, T_laser_board, board, 0.05, 0.03).size(), expected);
    }
  }
}

TEST(ReturnsOnBoard, AreNoneBehindOrBeforeTheBoard) {
  const Pose T_laser_board = laserBesideCamera().inverse() * Pose{{1, 0, 0, 0}, {0.0, 0.0, 1.0}};
  const Eigen::Vector3d middle = T_laser_board.translation;
  const CalibrationBoard board = plate();
  EXPECT_EQ(returnsOnBoard({middle}, T_laser_board, board, 0.01, 0.03).size(), 1U);
  EXPECT_TRUE(returnsOnBoard({1.05 * middle}, T_laser_board, board, 0.01, 0.03).empty());
  EXPECT_TRUE(returnsOnBoard({0.95 * middle}, T_laser_board, board, 0.01, 0.03).empty());
  EXPECT_TRUE(returnsOnBoard({-1.0 * middle}, T_laser_board, board, 0.01, 0.03).empty());
  EXPECT_TRUE(returnsOnBoard({Eigen::Vector3d::Zero()}, T_laser_board, board, 0.01, 0.03).empty());
}

TEST(BoardCandidates, OfABeamAreTheNearerOfTwoSurfaces) {
  Chance chance(2);
  ReturnSet readings = readingsAt(3.0, 60, chance);  // most of them go by the board
  append(readings, readingsAt(1.0, 40, chance));
  const auto candidates = boardCandidates(readings, LaserKind::beam, plate());
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates.front().size(), 40U);
  for (const Eigen::Vector3d& p : candidates.front()) EXPECT_NEAR(p.x(), 1.0, 0.03);
}

TEST(BoardCandidates, OfABeamAreNoStrayReadings) {
  Chance chance(3);
  ReturnSet readings = readingsAt(1.0, 90, chance);
  append(readings, readingsAt(0.4, 5, chance));  // less than a tenth: somebody's hand
  const auto candidates = boardCandidates(readings, LaserKind::beam, plate());
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_EQ(candidates.front().size(), 90U);
  EXPECT_TRUE(boardCandidates({}, LaserKind::beam, plate()).empty());
  EXPECT_TRUE(boardCandidates(readingsAt(1.0, 2, chance), LaserKind::beam, plate()).empty());
}

TEST(BoardCandidates, FindTheBoardInARoom) {
  Chance chance(4);
  const CalibrationBoard known = plate();
  CalibrationBoard unknown = known;
  unknown.width = unknown.height = 0.0;
  for (const LaserKind kind : {LaserKind::scan, LaserKind::cloud}) {
    for (const Pose& T_reference_board : boardsHeld(6, 4)) {
      const Pose T_laser_board = laserBesideCamera().inverse() * T_reference_board;
      const ReturnSet all = returnsOf(raysOf(kind), T_laser_board, known, {0.008, 0.0}, chance);
      const std::size_t there = returnsOnBoard(all, T_laser_board, known, 0.0, 0.05).size();
      for (const CalibrationBoard& board : {known, unknown}) {
        const auto candidates = boardCandidates(all, kind, board);
        ASSERT_FALSE(candidates.empty());
        const std::size_t on = returnsOnBoard(candidates.front(), T_laser_board, known, -0.005, 0.05).size();
        EXPECT_GT(static_cast<double>(on), 0.9 * static_cast<double>(there)) << "the likeliest is the board";
        EXPECT_GT(static_cast<double>(on), 0.97 * static_cast<double>(candidates.front().size()));
      }
    }
  }
}

TEST(BoardCandidates, AreNotMoreThanAskedFor) {
  Chance chance(5);
  const Pose T_laser_board = laserBesideCamera().inverse() * boardsHeld(1, 5).front();
  const ReturnSet all = returnsOf(raysOf(LaserKind::scan), T_laser_board, plate(), {0.008, 0.0}, chance);
  EXPECT_EQ(boardCandidates(all, LaserKind::scan, plate(), 1).size(), 1U);
  EXPECT_TRUE(boardCandidates(all, LaserKind::scan, plate(), 0).empty());
}

}  // namespace
}  // namespace thermovox::test
