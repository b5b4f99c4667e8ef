#include "calibration/pose_manifold.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

using Numbers = Eigen::Matrix<double, 7, 1>;

Numbers numbersOf(const Pose& pose) {
  Numbers numbers;
  numbers << pose.rotation.coeffs(), pose.translation;
  return numbers;
}

Eigen::Quaterniond rotationIn(const Numbers& numbers) {
  return Eigen::Quaterniond(numbers[3], numbers[0], numbers[1], numbers[2]);
}

Numbers plus(const ceres::Manifold& manifold, const Numbers& x, const Eigen::VectorXd& delta) {
  Numbers result;
  EXPECT_TRUE(manifold.Plus(x.data(), delta.data(), result.data()));
  return result;
}

Eigen::VectorXd minus(const ceres::Manifold& manifold, const Numbers& y, const Numbers& x) {
  Eigen::VectorXd result(manifold.TangentSize());
  EXPECT_TRUE(manifold.Minus(y.data(), x.data(), result.data()));
  return result;
}

/// Zero, tiny (where series take over), and up to just under half a turn.
std::vector<Eigen::Vector3d> turns() {
  Chance chance(1);
  std::vector<Eigen::Vector3d> turns{Eigen::Vector3d::Zero(), {1e-12, 0.0, 0.0}, {0.0, 3e-9, 1e-8}};
  for (const double angle : {1e-6, 0.1, 1.0, 3.0, std::numbers::pi - 1e-6})
    turns.push_back(angle * chance.normal3().normalized());
  return turns;
}

TEST(ExpRotationOf, IsTheProjectsExponential) {
  for (const Eigen::Vector3d& w : turns()) {
    EXPECT_LT(expRotationOf<double>(w).angularDistance(expRotation(w)), 1e-15) << w.transpose();
    EXPECT_NEAR(expRotationOf<double>(w).norm(), 1.0, 1e-15);
  }
}

TEST(LogRotationOf, UndoesTheExponential) {
  for (const Eigen::Vector3d& w : turns()) {
    const Eigen::Quaterniond q = expRotationOf<double>(w);
    // Half a turn away from the identity a quaternion's last bit is 1e-16 / 1e-6 of the angle.
    EXPECT_THAT(logRotationOf<double>(q), IsNear(w, 1e-9));
    EXPECT_THAT(logRotationOf<double>(Eigen::Quaterniond(-q.coeffs())), IsNear(w, 1e-9)) << "of -q";
  }
}

TEST(ExpRotationOf, HasItsDerivativeAtZero) {
  using Jet = ceres::Jet<double, 3>;
  const Eigen::Matrix<Jet, 3, 1> w(Jet(0.0, 0), Jet(0.0, 1), Jet(0.0, 2));
  const Eigen::Quaternion<Jet> q = expRotationOf<Jet>(w);
  EXPECT_THAT(q.x().v, IsNear(Eigen::Vector3d(0.5, 0.0, 0.0), 0.0));
  EXPECT_THAT(q.y().v, IsNear(Eigen::Vector3d(0.0, 0.5, 0.0), 0.0));
  EXPECT_THAT(q.z().v, IsNear(Eigen::Vector3d(0.0, 0.0, 0.5), 0.0));
  EXPECT_THAT(q.w().v, IsNear(Eigen::Vector3d(0.0, 0.0, 0.0), 0.0));
}

TEST(PoseManifold, TurnsInTheFrameItLeadsToByTheFullAngle) {
  const PoseManifold manifold;
  const Pose pose = Chance(2).pose(1.0, 1.0);
  for (const Eigen::Vector3d& w : turns()) {
    Eigen::VectorXd delta(6);
    delta << w, 0.1, -0.2, 0.3;
    const Numbers moved = plus(manifold, numbersOf(pose), delta);
    EXPECT_LT(rotationIn(moved).angularDistance(expRotation(w) * pose.rotation), 1e-14);
    EXPECT_THAT(moved.tail<3>(), IsNear(pose.translation + Eigen::Vector3d(0.1, -0.2, 0.3), 1e-15));
  }
}

TEST(LaserManifold, TurnsInTheLaserByTheFullAngle) {
  const LaserManifold manifold;
  const Pose pose = Chance(3).pose(1.0, 1.0);
  for (const Eigen::Vector3d& w : turns()) {
    Eigen::VectorXd delta(6);
    delta << w, 0.1, -0.2, 0.3;
    const Numbers moved = plus(manifold, numbersOf(pose), delta);
    EXPECT_LT(rotationIn(moved).angularDistance(pose.rotation * expRotation(w)), 1e-14);
    EXPECT_THAT(moved.tail<3>(), IsNear(pose.translation + Eigen::Vector3d(0.1, -0.2, 0.3), 1e-15));
  }
}

TEST(BeamManifold, LeavesTheRollAsItIs) {
  const BeamManifold manifold;
  const Pose pose = Chance(4).pose(1.0, 1.0);
  Eigen::VectorXd delta(5);
  delta << 0.3, -0.5, 0.1, -0.2, 0.3;
  const Numbers moved = plus(manifold, numbersOf(pose), delta);
  const Eigen::Vector3d w = logRotationOf<double>(pose.rotation.conjugate() * rotationIn(moved));
  EXPECT_THAT(w, IsNear(Eigen::Vector3d(0.0, 0.3, -0.5), 1e-14));
  EXPECT_EQ(manifold.TangentSize(), 5);
}

TEST(BeamManifold, DoesNotSeeTheRoll) {
  const BeamManifold manifold;
  const Pose pose = Chance(5).pose(1.0, 1.0);
  const Pose rolled{pose.rotation * expRotation({0.7, 0.0, 0.0}), pose.translation};
  EXPECT_THAT(minus(manifold, numbersOf(rolled), numbersOf(pose)), IsNear(Eigen::VectorXd::Zero(5), 1e-14));
}

template <typename T>
class AnyManifold : public testing::Test {};
using Manifolds = testing::Types<PoseManifold, LaserManifold, BeamManifold>;
TYPED_TEST_SUITE(AnyManifold, Manifolds);

TYPED_TEST(AnyManifold, MinusUndoesPlusWhicheverSignTheQuaternionHas) {
  const TypeParam manifold;
  Chance chance(6);
  for (int i = 0; i < 100; ++i) {
    const Numbers x = numbersOf(chance.pose(1.0, 1.0));
    Eigen::VectorXd delta(manifold.TangentSize());
    for (double& d : delta) d = chance.uniform(-1.7, 1.7);  // its rotation is less than half a turn
    Numbers y = plus(manifold, x, delta);
    EXPECT_THAT(minus(manifold, y, x), IsNear(delta, 1e-12));
    y.head<4>() = -y.head<4>();
    EXPECT_THAT(minus(manifold, y, x), IsNear(delta, 1e-12));
  }
}

TYPED_TEST(AnyManifold, PlusOfNothingIsTheSame) {
  const TypeParam manifold;
  const Numbers x = numbersOf(Chance(7).pose(1.0, 1.0));
  EXPECT_THAT(plus(manifold, x, Eigen::VectorXd::Zero(manifold.TangentSize())), IsNear(x, 1e-15));
}

TYPED_TEST(AnyManifold, KnowsItsDerivatives) {
  const TypeParam manifold;
  const Eigen::Index n = manifold.TangentSize();
  const Numbers x = numbersOf(Chance(8).pose(1.0, 1.0));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> forth(7, n), back(n, 7);
  ASSERT_TRUE(manifold.PlusJacobian(x.data(), forth.data()));
  ASSERT_TRUE(manifold.MinusJacobian(x.data(), back.data()));
  constexpr double kStep = 1e-6;  // central differences of it err by 1e-12 of curvature, 1e-10 of rounding
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd delta = kStep * Eigen::VectorXd::Unit(n, i);
    const Numbers slope = (plus(manifold, x, delta) - plus(manifold, x, -delta)) / (2.0 * kStep);
    EXPECT_THAT(forth.col(i), IsNear(slope, 1e-8));
  }
  EXPECT_THAT(Eigen::MatrixXd(back * forth), IsNear(Eigen::MatrixXd::Identity(n, n), 1e-12));
}

}  // namespace
}  // namespace thermovox::test
