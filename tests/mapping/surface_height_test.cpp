#include "mapping/surface_height.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

namespace thermovox {
namespace {

constexpr double kEachAlone = 1e-6;  // metres: no two points in one column
const Eigen::Vector3d kOrigin(12.0, -7.0, 3.0);
const Eigen::Vector3d kNormal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
const Eigen::Vector3d kAlong = kNormal.unitOrthogonal();
const Eigen::Vector3d kAcross = kNormal.cross(kAlong);

/// Points of a surface that lies height(u, v) over the plane, within 0.2 m of a place.
template <typename Height>
std::vector<HeightPoint> points(std::size_t count, Height&& height, double sigma = 0.0,
                                std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-0.2, 0.2);
  std::normal_distribution<double> normal;
  std::vector<HeightPoint> points(count);
  for (HeightPoint& point : points) {
    const double u = place(random), v = place(random);
    point.p_world = kOrigin + u * kAlong + v * kAcross + (height(u, v) + sigma * normal(random)) * kNormal;
  }
  return points;
}

TEST(SurfaceHeight, OfATiltedPlaneIsWhereItPassesTheOrigin) {
  const auto plane = points(40, [](double u, double v) { return 0.013 + 0.3 * u - 0.2 * v; });
  const auto height = surfaceHeight(plane, kOrigin, kNormal, kEachAlone);
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->height, 0.013, 1e-10);
  EXPECT_NEAR(height->sigma, 0.0, 1e-9);
}

TEST(SurfaceHeight, IsNotFooledByACurvedSurface) {
  // A pipe of 0.3 m radius: the mean of the points lies 23 mm below its crest.
  const auto pipe = [](double u, double) { return std::sqrt(0.09 - u * u) - 0.3; };
  const auto height = surfaceHeight(points(200, pipe), kOrigin, kNormal, kEachAlone);
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->height, 0.0, 2e-3);  // what the quadric leaves of the fourth order
  const auto quadric = [](double u, double v) { return 0.02 + u - 2 * v + 3 * u * u - u * v + 0.5 * v * v; };
  EXPECT_NEAR(surfaceHeight(points(12, quadric), kOrigin, kNormal, kEachAlone)->height, 0.02, 1e-9);
}

TEST(SurfaceHeight, SigmaIsWhatTheHeightScattersBy) {
  double squares = 0.0, promised = 0.0;
  constexpr int kRuns = 500;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto flat = points(
        60, [](double u, double) { return 0.1 * u; }, 0.005, seed);
    const auto height = surfaceHeight(flat, kOrigin, kNormal, kEachAlone);
    ASSERT_TRUE(height);
    squares += height->height * height->height;
    promised += height->sigma * height->sigma;
  }
  // The ratio of two variances of 500 runs: good to 6 % at one sigma.
  EXPECT_NEAR(squares / promised, 1.0, 0.2);
}

TEST(SurfaceHeight, OfFewPointsIsTheirMean) {
  std::vector<HeightPoint> few;
  for (const double h : {0.01, 0.02, 0.06}) few.push_back({kOrigin + h * kAlong + h * kNormal});
  const auto height = surfaceHeight(few, kOrigin, kNormal, kEachAlone);
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->height, 0.03, 1e-12);
  // (4 + 1 + 9)e-4 over three points; of the two degrees of freedom Student's t leaves one at least.
  EXPECT_NEAR(height->sigma, std::sqrt(14e-4 / 3.0), 1e-9);
  EXPECT_FALSE(surfaceHeight({}, kOrigin, kNormal, kEachAlone));
}

TEST(SurfaceHeight, OfPointsOnALineIsTheirMean) {
  std::vector<HeightPoint> line;
  for (int i = 0; i < 30; ++i) line.push_back({kOrigin + (i - 14.5) * 0.01 * kAlong + 0.004 * kNormal});
  const auto height = surfaceHeight(line, kOrigin, kNormal, kEachAlone);
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->height, 0.004, 1e-9);
  EXPECT_TRUE(std::isfinite(height->sigma));
}

TEST(SurfaceHeight, CountsReturnsAndNotTheCellsThatHoldThem) {
  const std::vector<HeightPoint> two{{kOrigin + 0.02 * kNormal, 30.0},
                                     {kOrigin + 0.1 * kAlong + 0.06 * kNormal, 10.0}};
  EXPECT_NEAR(surfaceHeight(two, kOrigin, kNormal, kEachAlone)->height, 0.03, 1e-12);
}

/// 1500 returns of a wall z = `wall` with noise of 1 cm, cell by cell of 5 cm as a map holds them.
std::vector<HeightPoint> cellsOfWall(double wall, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-0.2, 0.2);
  std::normal_distribution<double> noise(wall, 0.01);
  std::map<std::tuple<int, int, int>, HeightPoint> cells;
  for (int i = 0; i < 1500; ++i) {
    const Eigen::Vector3d p(place(random), place(random), noise(random));
    const auto index = [&](int axis) { return static_cast<int>(std::floor(p[axis] / 0.05)); };
    HeightPoint& cell =
        cells.try_emplace({index(0), index(1), index(2)}, HeightPoint{Eigen::Vector3d::Zero(), 0.0})
            .first->second;
    cell.p_world += p;
    cell.returns += 1.0;
  }
  std::vector<HeightPoint> points;
  for (const auto& [key, cell] : cells) points.push_back({cell.p_world / cell.returns, cell.returns});
  return points;
}

TEST(SurfaceHeight, OfAWallNearABorderOfCellsIsWhereItsReturnsAre) {
  double squares = 0.0, promised = 0.0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    const double wall = 0.002 * (run % 25);  // through all of a cell, its borders too
    const auto found = surfaceHeight(cellsOfWall(wall, static_cast<std::uint64_t>(run)),
                                     Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0.05);
    ASSERT_TRUE(found);
    squares += std::pow(found->height - wall, 2) / kRuns;
    promised += found->sigma * found->sigma / kRuns;
  }
  // A quadric over a square knows its middle to 1.9 times 10 mm / sqrt(1500); cells alike would err by 3 mm.
  EXPECT_LT(std::sqrt(squares), 0.0007);
  EXPECT_NEAR(squares / promised, 1.0, 0.5);
}

}  // namespace
}  // namespace thermovox
