#include "calibration/cloud_board.hpp"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {
namespace {

/// Nothing but walls.
ReturnSet emptyRoom(Chance& chance) {
  ReturnSet returns;
  for (const Eigen::Vector3d& ray : raysOf(LaserKind::cloud))
    returns.emplace_back((rangeOfRoom(ray) + chance.normal(0.008)) * ray);
  return returns;
}

/// Of the first candidate, what lies on the plate at T_laser_board.
double shareOnPlate(const std::vector<ReturnSet>& candidates, const Pose& T_laser_board) {
  if (candidates.empty()) return 0.0;
  const ReturnSet& first = candidates.front();
  return static_cast<double>(returnsOnBoard(first, T_laser_board, plate(), -0.005, 0.05).size()) /
         static_cast<double>(first.size());
}

TEST(BoardsInCloud, FindTheBoardByItsSize) {
  Chance chance(1);
  for (const Pose& T_reference_board : boardsHeld(8, 11)) {
    const Pose T_laser_board = laserBesideCamera().inverse() * T_reference_board;
    const ReturnSet all = returnsOf(raysOf(LaserKind::cloud), T_laser_board, plate(), {0.008, 0.0}, chance);
    EXPECT_GT(shareOnPlate(boardsInCloud(all, {{0.60, 0.42}, 1.0}), T_laser_board), 0.97);
    // By its pattern, which is 54 x 36 cm: a plate up to 1.4 times as large.
    EXPECT_GT(shareOnPlate(boardsInCloud(all, {{0.54, 0.36}, 1.4}), T_laser_board), 0.97);
  }
}

TEST(BoardsInCloud, AreNoWalls) {
  Chance chance(2);
  EXPECT_TRUE(boardsInCloud(emptyRoom(chance), {{0.60, 0.42}, 1.0}).empty());
}

TEST(BoardsInCloud, AreNoPlatesOfAnotherSize) {
  Chance chance(3);
  const Pose T_laser_board = laserBesideCamera().inverse() * boardsHeld(1, 3).front();
  const ReturnSet all = returnsOf(raysOf(LaserKind::cloud), T_laser_board, plate(), {0.008, 0.0}, chance);
  EXPECT_LT(shareOnPlate(boardsInCloud(all, {{1.2, 0.84}, 1.0}), T_laser_board), 0.5) << "half as large";
  EXPECT_LT(shareOnPlate(boardsInCloud(all, {{0.30, 0.21}, 1.0}), T_laser_board), 0.5) << "twice as large";
}

TEST(BoardsInCloud, AreTheSameEveryTime) {
  Chance chance(4);
  const Pose T_laser_board = laserBesideCamera().inverse() * boardsHeld(1, 4).front();
  const ReturnSet all = returnsOf(raysOf(LaserKind::cloud), T_laser_board, plate(), {0.008, 0.0}, chance);
  EXPECT_EQ(boardsInCloud(all, {{0.60, 0.42}, 1.0}), boardsInCloud(all, {{0.60, 0.42}, 1.0}));
}

TEST(BoardsInCloud, NeedPoints) {
  EXPECT_TRUE(boardsInCloud({}, {{0.60, 0.42}, 1.0}).empty());
  EXPECT_TRUE(boardsInCloud(ReturnSet(19, {1.0, 0.0, 0.0}), {{0.60, 0.42}, 1.0}).empty());
  EXPECT_TRUE(boardsInCloud(ReturnSet(500, {1.0, 0.0, 0.0}), {{0.60, 0.42}, 1.0}).empty())
      << "one place, five hundred times";
}

}  // namespace
}  // namespace thermovox::test
