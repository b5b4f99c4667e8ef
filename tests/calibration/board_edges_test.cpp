#include "calibration/board_edges.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {
namespace {

/// A board that faces the laser a metre before it: its x is to the right, its y down. What of it the laser's
/// own height (z = 0) meets is `down` below its middle, `right` of it straight ahead.
Pose facingLaser(double down, double right = 0.0) {
  Eigen::Matrix3d R;
  R << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return {Eigen::Quaterniond(R), {1.0, right, down}};
}

/// Where a crossing's ray meets the board's plane.
Eigen::Vector2d hitOf(const EdgeCrossing& crossing, const Pose& T_laser_board) {
  const Pose T_board_laser = T_laser_board.inverse();
  const Eigen::Vector3d ray = T_board_laser.rotation * crossing.ray;
  return (T_board_laser.translation - T_board_laser.translation.z() / ray.z() * ray).head<2>();
}

struct Edges {
  std::size_t crossings = 0;
  double mean_square = 0.0;                ///< of what they are off, in their sigmas
  std::set<std::pair<int, double>> sides;  ///< axis, place
};

Edges edgesOf(LaserKind kind, const Pose& T_laser_board, Chance& chance) {
  const ReturnSet returns = returnsOf(raysOf(kind), T_laser_board, plate(), {0.004, 0.0}, chance);
  Edges edges;
  for (const EdgeSide& side : edgeSides(returns, kind, T_laser_board, plate(), 0.004)) {
    EXPECT_FALSE(side.crossings.empty());
    for (const EdgeCrossing& crossing : side.crossings) {
      const double off = hitOf(crossing, T_laser_board)[crossing.axis] - crossing.place;
      edges.mean_square += std::pow(off, 2) / (std::pow(crossing.sigma, 2) + std::pow(side.offset_sigma, 2));
      EXPECT_EQ(crossing.axis, side.crossings.front().axis) << "one side";
      EXPECT_EQ(crossing.place, side.crossings.front().place) << "one side";
      edges.sides.insert({crossing.axis, crossing.place});
      ++edges.crossings;
    }
  }
  edges.mean_square /= static_cast<double>(std::max<std::size_t>(1, edges.crossings));
  return edges;
}

TEST(EdgeSides, OfAScanAreWhereItsLineLeavesThePlate) {
  Chance chance(1);
  const Edges edges = edgesOf(LaserKind::scan, facingLaser(0.05), chance);
  EXPECT_EQ(edges.crossings, 2U);
  EXPECT_EQ(edges.sides, (std::set<std::pair<int, double>>{{0, -0.30}, {0, 0.30}}));
}

TEST(EdgeSides, OfACloudAreAllFour) {
  Chance chance(2);
  const Edges edges = edgesOf(LaserKind::cloud, facingLaser(0.003, 0.003), chance);
  EXPECT_EQ(edges.sides, (std::set<std::pair<int, double>>{{0, -0.30}, {0, 0.30}, {1, -0.21}, {1, 0.21}}));
  EXPECT_GT(edges.crossings, 100U);
}

TEST(EdgeSides, AreAsFarOffAsTheySay) {
  Chance chance(3);
  for (const LaserKind kind : {LaserKind::scan, LaserKind::cloud}) {
    double squares = 0.0;
    std::size_t crossings = 0;
    for (const Pose& T_reference_board : boardsHeld(30, 3)) {
      const Edges edges = edgesOf(kind, laserBesideCamera().inverse() * T_reference_board, chance);
      squares += edges.mean_square * static_cast<double>(edges.crossings);
      crossings += edges.crossings;
    }
    ASSERT_GT(crossings, 20U);
    // An edge lies anywhere in a gap between two rays: the mean square of that is 1 by the sigma of a gap
    // over sqrt(12); half a millimetre and what a wide gap's slant adds leave it below. It must not be above
    // by more than chance: four of sqrt(0.8 / n), the kurtosis of a uniform one, n the sides that are
    // independent.
    EXPECT_LT(squares / static_cast<double>(crossings), 1.0 + 4.0 * std::sqrt(0.8 / 60.0));
    EXPECT_GT(squares / static_cast<double>(crossings), 0.3);
  }
}

TEST(EdgeSides, LeaveOutCorners) {
  Chance chance(4);
  // The scan's line meets both vertical edges within 5 mm of a corner.
  EXPECT_EQ(edgesOf(LaserKind::scan, facingLaser(0.205), chance).crossings, 0U);
  const Pose board = facingLaser(0.0);
  const ReturnSet returns = returnsOf(raysOf(LaserKind::cloud), board, plate(), {}, chance);
  for (const EdgeSide& side : edgeSides(returns, LaserKind::cloud, board, plate(), 0.004)) {
    for (const EdgeCrossing& crossing : side.crossings) {
      const Eigen::Vector2d hit = hitOf(crossing, board);
      const double to_next = crossing.axis == 0 ? 0.21 - std::abs(hit.y()) : 0.30 - std::abs(hit.x());
      EXPECT_GT(to_next, 0.02) << "of a corner";
    }
  }
}

TEST(EdgeSides, AreNoneOfAPlateThatIsNotKnown) {
  Chance chance(5);
  CalibrationBoard unknown = plate();
  unknown.height = 0.0;
  const ReturnSet returns = returnsOf(raysOf(LaserKind::cloud), facingLaser(0.0), plate(), {}, chance);
  EXPECT_TRUE(edgeSides(returns, LaserKind::cloud, facingLaser(0.0), unknown, 0.004).empty());
}

TEST(EdgeSides, AreNoneWhereNothingIsBehind) {
  ReturnSet returns;  // the walls are too far to be seen
  for (const Eigen::Vector3d& ray : raysOf(LaserKind::cloud)) {
    if (const auto range = rangeOfPlate(ray, facingLaser(0.0), plate())) returns.emplace_back(*range * ray);
  }
  EXPECT_TRUE(edgeSides(returns, LaserKind::cloud, facingLaser(0.0), plate(), 0.004).empty());
}

/// A beam's readings, of which every `each`-th is from the wall behind.
ReturnSet jumpingBeam(std::size_t each) {
  ReturnSet readings;
  for (std::size_t i = 0; i < 100; ++i)
    readings.emplace_back(each > 0 && i % each == 0 ? 3.0 : 1.0, 0.0, 0.0);
  return readings;
}

TEST(EdgeSides, OfABeamAreWhereItJumps) {
  const Pose at_edge = facingLaser(0.05, 0.298);  // straight ahead is 2 mm inside of the right edge
  const auto sides = edgeSides(jumpingBeam(3), LaserKind::beam, at_edge, plate(), 0.004);
  ASSERT_EQ(sides.size(), 1U);
  ASSERT_EQ(sides.front().crossings.size(), 1U);
  const EdgeCrossing& crossing = sides.front().crossings.front();
  EXPECT_EQ(crossing.axis, 0);
  EXPECT_EQ(crossing.place, 0.30);
  EXPECT_EQ(crossing.ray, Eigen::Vector3d(1.0, 0.0, 0.0));
  EXPECT_GT(crossing.sigma, 0.002);
}

TEST(EdgeSides, OfABeamAreNoneWhereItDoesNotJumpOrIsNotAtAnEdge) {
  const Pose at_edge = facingLaser(0.05, 0.298), inside = facingLaser(0.05, 0.1);
  EXPECT_TRUE(edgeSides(jumpingBeam(0), LaserKind::beam, at_edge, plate(), 0.004).empty());
  EXPECT_TRUE(edgeSides(jumpingBeam(20), LaserKind::beam, at_edge, plate(), 0.004).empty())
      << "five strays of a hundred";
  EXPECT_TRUE(edgeSides(jumpingBeam(3), LaserKind::beam, inside, plate(), 0.004).empty());
}

}  // namespace
}  // namespace thermovox::test
