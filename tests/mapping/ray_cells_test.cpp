#include "mapping/ray_cells.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <random>
#include <vector>

namespace thermovox {
namespace {

std::vector<CellKey> walk(const Eigen::Vector3d& origin, const Eigen::Vector3d& end, double resolution) {
  std::vector<CellKey> cells;
  RayCells(origin, end, resolution).forEach([&](const CellKey& key) { cells.push_back(key); });
  return cells;
}

octomap::point3d octomapPoint(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

std::vector<CellKey> walkOfOctomap(const octomap::OcTree& tree, const Eigen::Vector3d& origin,
                                   const Eigen::Vector3d& end) {
  octomap::KeyRay ray;
  EXPECT_TRUE(tree.computeRayKeys(octomapPoint(origin), octomapPoint(end), ray));
  std::vector<CellKey> cells;
  for (const octomap::OcTreeKey& key : ray) {
    cells.push_back({key[0] - kOctomapReach, key[1] - kOctomapReach, key[2] - kOctomapReach});
  }
  return cells;
}

constexpr double kResolutions[] = {0.05, 0.1, 0.2, 0.37};

TEST(RayCells, AreThoseOfOctomapOnRandomRays) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> coordinate(-30.0, 30.0);
  for (const double resolution : kResolutions) {
    const octomap::OcTree tree(resolution);
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d origin(coordinate(rng), coordinate(rng), coordinate(rng) / 5);
      const Eigen::Vector3d end(coordinate(rng), coordinate(rng), coordinate(rng) / 5);
      ASSERT_EQ(walk(origin, end, resolution), walkOfOctomap(tree, origin, end)) << origin << '\n' << end;
    }
  }
}

// Coordinates on a coarse grid: rays along axes and diagonals, through corners and along borders.
TEST(RayCells, AreThoseOfOctomapOnAxesDiagonalsAndBorders) {
  std::mt19937 rng(12);
  std::uniform_int_distribution<int> steps(-12, 12);
  for (const double resolution : kResolutions) {
    const octomap::OcTree tree(resolution);
    for (int i = 0; i < 5000; ++i) {
      const auto corner = [&]() -> Eigen::Vector3d {
        return Eigen::Vector3d(steps(rng), steps(rng), steps(rng)) * (resolution / 2);
      };
      const Eigen::Vector3d origin = corner(), end = corner();
      ASSERT_EQ(walk(origin, end, resolution), walkOfOctomap(tree, origin, end)) << origin << '\n' << end;
    }
  }
}

TEST(RayCells, AreThoseOfOctomapOnShortRays) {
  std::mt19937 rng(13);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0), step(-0.12, 0.12);
  const octomap::OcTree tree(0.1);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d origin(coordinate(rng), coordinate(rng), coordinate(rng));
    const Eigen::Vector3d end = origin + Eigen::Vector3d(step(rng), step(rng), step(rng));
    ASSERT_EQ(walk(origin, end, 0.1), walkOfOctomap(tree, origin, end)) << origin << '\n' << end;
  }
}

TEST(RayCells, AreNoneWithinOneCell) {
  EXPECT_TRUE(walk({0.01, 0.01, 0.01}, {0.09, 0.05, 0.02}, 0.1).empty());
}

TEST(RayCells, EndForARayTooShortForAFloat) {
  EXPECT_EQ(walk({0.05, 0.05, -1e-40}, {0.05, 0.05, 1e-40}, 0.1), (std::vector<CellKey>{{0, 0, -1}}));
}

TEST(RayCells, FarFromTheOriginAreThoseNearIt) {
  const double resolution = 0.05;
  const Eigen::Vector3d origin(0.523, 1.237, 0.411), end(7.031, -3.377, 2.713);
  const CellKey shift{16'000'000, -20'000'000, 0};
  const Eigen::Vector3d offset = Eigen::Vector3d(shift.x, shift.y, shift.z) * resolution;
  std::vector<CellKey> far = walk(origin + offset, end + offset, resolution);
  for (CellKey& key : far) key = {key.x - shift.x, key.y - shift.y, key.z - shift.z};
  EXPECT_EQ(far, walk(origin, end, resolution));
}

}  // namespace
}  // namespace thermovox
