#include "calibration/scan_board.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {
namespace {

Eigen::Vector3d at(double angle_deg, double range) {
  return range * Eigen::Vector3d(std::cos(angle_deg * kDegree), std::sin(angle_deg * kDegree), 0.0);
}

/// A straight object between two angles, as far as `range` in its middle and square to the ray there.
ReturnSet wallAt(double from_deg, double to_deg, double range) {
  ReturnSet returns;
  const double middle = 0.5 * (from_deg + to_deg);
  for (double a = from_deg; a <= to_deg; a += 0.25)
    returns.push_back(at(a, range / std::cos((a - middle) * kDegree)));
  return returns;
}

void append(ReturnSet& to, const ReturnSet& more) {
  to.insert(to.end(), more.begin(), more.end());
}

TEST(ScanRays, AreMediansOfTheSweepsByAngle) {
  ReturnSet returns;
  for (const double range : {1.0, 1.1, 5.0}) {
    for (const double angle : {10.0, -20.0, 30.0}) returns.push_back(at(angle, range));
  }
  const auto rays = scanRays(returns);
  ASSERT_EQ(rays.size(), 3U);
  EXPECT_TRUE(std::is_sorted(rays.begin(), rays.end(),
                             [](const ScanRay& a, const ScanRay& b) { return a.angle < b.angle; }));
  for (const ScanRay& ray : rays) {
    EXPECT_NEAR(ray.range, 1.1, 1e-12);
    EXPECT_EQ(ray.returns.size(), 3U);
  }
  EXPECT_TRUE(scanRays({}).empty());
}

TEST(BoardsInScan, PutWhatStandsInFrontFirst) {
  ReturnSet returns = wallAt(-60.0, -15.25, 3.0);
  append(returns, wallAt(-15.0, 15.0, 1.0));  // 54 cm, before the others
  append(returns, wallAt(15.25, 25.0, 2.9));  // half a metre, but far behind the board
  append(returns, wallAt(25.25, 60.0, 3.3));
  const auto boards = boardsInScan(returns, {0.60, 0.42});
  ASSERT_FALSE(boards.empty());
  EXPECT_EQ(boards.front().size(), 121U);
  for (const Eigen::Vector3d& p : boards.front()) EXPECT_NEAR(p.x(), 1.0, 1e-9);
}

TEST(BoardsInScan, AreNoLongerThanTheBoard) {
  EXPECT_TRUE(boardsInScan(wallAt(-45.0, 45.0, 1.0), {0.60, 0.42}).empty()) << "two metres";
  EXPECT_EQ(boardsInScan(wallAt(-16.0, 16.0, 1.0), {0.60, 0.42}).size(), 1U);
  EXPECT_TRUE(boardsInScan(wallAt(-1.0, 1.0, 1.0), {0.60, 0.42}).empty()) << "3.5 cm are too little";
}

TEST(BoardsInScan, AreStraight) {
  ReturnSet round;  // a pillar of 40 cm
  for (double a = -15.0; a <= 15.0; a += 0.25) {
    const double across = std::sin(a * kDegree) / std::sin(15.5 * kDegree);
    round.push_back(at(a, 1.0 - 0.2 * std::sqrt(std::max(0.0, 1.0 - across * across))));
  }
  EXPECT_TRUE(boardsInScan(round, {0.60, 0.42}).empty());
}

TEST(BoardsInScan, AreNoneWhereThereIsNothing) {
  EXPECT_TRUE(boardsInScan({}, {0.60, 0.42}).empty());
}

}  // namespace
}  // namespace thermovox::test
