#include "projection/pose.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/projection/matchers.hpp"

namespace thermovox {
namespace {

using test::IsNear;

/// A pose as a 4 x 4 matrix: the oracle of the algebra below.
Eigen::Matrix4d homogeneous(const Pose& pose) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = pose.matrix();
  m.topRightCorner<3, 1>() = pose.translation;
  return m;
}

class PoseOf : public testing::Test {
 protected:
  std::mt19937_64 random_{5};
  std::normal_distribution<double> normal_;

  Eigen::Vector3d vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }
  Pose pose() { return {expRotation(vector()), 10.0 * vector()}; }
};

TEST_F(PoseOf, ProductsAndInversesAreThoseOfMatrices) {
  for (int i = 0; i < 200; ++i) {
    const Pose T_a_b = pose();
    const Pose T_b_c = pose();
    const Eigen::Vector3d p_c = vector();
    EXPECT_THAT(homogeneous(T_a_b * T_b_c), IsNear(homogeneous(T_a_b) * homogeneous(T_b_c), 1e-12));
    EXPECT_THAT(homogeneous(T_a_b.inverse()), IsNear(homogeneous(T_a_b).inverse(), 1e-12));
    EXPECT_THAT(T_a_b * (T_b_c * p_c), IsNear((T_a_b * T_b_c) * p_c, 1e-12));
  }
}

TEST_F(PoseOf, LongChainsStayRotations) {
  const Pose step = pose();
  Pose chain;
  for (int i = 0; i < 100'000; ++i) chain = chain * step;
  EXPECT_NEAR(chain.rotation.norm(), 1.0, 1e-15);
}

TEST_F(PoseOf, SmallRotationsAreTheCrossProductToFirstOrder) {
  for (const double size : {1e-5, 1e-9, 1e-13, 0.0}) {
    const Eigen::Vector3d w = size * vector();
    const Eigen::Vector3d p = vector();
    // The second order of Exp is |w|^2 |p| / 2.
    EXPECT_THAT(expRotation(w) * p, IsNear(p + skew(w) * p, w.squaredNorm() * p.norm() + 1e-15)) << size;
  }
}

TEST_F(PoseOf, ExpOfARotationVectorTurnsByItsLength) {
  const Eigen::Vector3d turned = expRotation({0.0, 0.0, M_PI / 2}) * Eigen::Vector3d::UnitX();
  EXPECT_THAT(turned, IsNear(Eigen::Vector3d::UnitY(), 1e-15));
}

}  // namespace
}  // namespace thermovox
