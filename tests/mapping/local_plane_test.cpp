#include "mapping/local_plane.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace thermovox {
namespace {

/// Points about a plane with that unit normal, 0.4 m wide in one direction and `width` in the other.
PointSums patch(const Eigen::Vector3d& normal, double width, double noise) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> along(-0.5, 0.5);
  std::normal_distribution<double> off(0.0, noise);
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  PointSums sums;
  for (int i = 0; i < 400; ++i)
    sums.add(0.4 * along(random) * u + width * along(random) * v + off(random) * normal);
  return sums;
}

TEST(LocalPlane, IsThatOfThePoints) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  const LocalPlane plane = localPlane(patch(normal, 0.3, 0.01));
  EXPECT_GT(std::abs(plane.normal.cast<double>().dot(normal)), 0.999);
  EXPECT_NEAR(plane.width2, 0.3 * 0.3 / 12.0, 1e-3);
}

TEST(LocalPlane, IsNoneOfABall) {
  EXPECT_TRUE(localPlane(patch(Eigen::Vector3d::UnitZ(), 0.3, 0.1)).normal.isZero());
}

TEST(LocalPlane, OfALineIsNarrow) {
  EXPECT_LT(localPlane(patch(Eigen::Vector3d::UnitX(), 0.005, 1e-4)).width2, 1e-5);
}

}  // namespace
}  // namespace thermovox
