// First-order covariances against the spread of seeded random draws of the same errors.
#include "projection/position_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <functional>
#include <random>

#include "tests/projection/matchers.hpp"

namespace thermovox {
namespace {

using test::IsNear;

const Pose kT_body_laser{expRotation({0.4, -0.3, 1.2}), {0.3, -0.2, 0.5}};
const Pose kT_world_body{expRotation({0.1, 0.7, -2.0}), {20.0, -5.0, 3.0}};
const Eigen::Vector3d kP_laser(4.0, -3.0, 1.0);

class PositionCovarianceOf : public testing::Test {
 protected:
  std::mt19937_64 random_{9};
  std::normal_distribution<double> normal_;

  Vector6d normalVector6() {
    return Vector6d::NullaryExpr([this] { return normal_(random_); });
  }

  /// Covariance of 100 000 draws: each entry is good to about sqrt(2 / 100 000) = 0.45 % of its size. The
  /// errors below are some 0.01 rad, so the second order adds 1e-4 of it.
  static constexpr double kTolerance = 0.02;
  static Eigen::Matrix3d spread(const std::function<Eigen::Vector3d()>& draw) {
    constexpr int kDraws = 100'000;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    const Eigen::Vector3d reference = draw();
    for (int i = 0; i < kDraws; ++i) {
      const Eigen::Vector3d difference = draw() - reference;
      sum += difference;
      squares += difference * difference.transpose();
    }
    return (squares - sum * sum.transpose() / kDraws) / (kDraws - 1);
  }

  static void expectEqual(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& expected) {
    EXPECT_THAT(covariance, IsNear(expected, kTolerance * expected.norm()));
  }

  /// A covariance with correlations, of about 6 mrad and 1 cm.
  Matrix6d declaredExtrinsics() {
    Matrix6d A;
    for (int column = 0; column < 6; ++column) A.col(column) = normalVector6();
    Vector6d scale;
    scale << 0.0025, 0.0025, 0.0025, 0.004, 0.004, 0.004;
    A = scale.asDiagonal() * A;
    return A * A.transpose();
  }
};

TEST_F(PositionCovarianceOf, RangeNoiseLiesAlongTheRay) {
  const Laser laser{.T_body_laser = kT_body_laser, .range_sigma = 0.03};
  const PositionCovariance covariance = positionCovariance({}, laser, kT_world_body, kP_laser);
  expectEqual(covariance.random, spread([&] {
                const double range = kP_laser.norm() + 0.03 * normal_(random_);
                return kT_world_body * (kT_body_laser * (range * kP_laser.normalized()));
              }));
  EXPECT_TRUE(covariance.extrinsic.isZero(0.0));
  EXPECT_TRUE(covariance.pose.isZero(0.0));
}

TEST_F(PositionCovarianceOf, RangeBiasIsSharedByAllReturns) {
  const Laser laser{.T_body_laser = kT_body_laser, .range_sigma = 0.0, .range_bias_sigma = 0.05};
  const PositionCovariance covariance = positionCovariance({}, laser, kT_world_body, kP_laser);
  EXPECT_TRUE(covariance.random.isZero(0.0));
  const Eigen::Vector3d ray = kT_world_body.rotation * (kT_body_laser.rotation * kP_laser.normalized());
  EXPECT_THAT(covariance.extrinsic, IsNear(Eigen::Matrix3d(0.05 * 0.05 * ray * ray.transpose()), 1e-15));
}

TEST_F(PositionCovarianceOf, ExtrinsicsMoveThePointAboutTheBodysAxes) {
  Laser laser{.T_body_laser = kT_body_laser, .range_sigma = 0.0};
  laser.covariance_body_laser = declaredExtrinsics();
  const Matrix6d root = laser.covariance_body_laser.llt().matrixL();
  const PositionCovariance covariance = positionCovariance({}, laser, kT_world_body, kP_laser);
  expectEqual(covariance.extrinsic, spread([&] {
                const Vector6d error = root * normalVector6();  // R' = Exp(w) R, t' = t + v
                const Pose moved{expRotation(error.head<3>()) * kT_body_laser.rotation,
                                 kT_body_laser.translation + error.tail<3>()};
                return kT_world_body * (moved * kP_laser);
              }));
  EXPECT_TRUE(covariance.random.isZero(0.0));
  EXPECT_TRUE(covariance.pose.isZero(0.0));
}

TEST_F(PositionCovarianceOf, PoseErrorMovesThePointAboutTheBody) {
  Mission mission;
  mission.pose_rotation_sigma = 0.004;
  mission.pose_translation_sigma = 0.02;
  const Laser laser{.T_body_laser = kT_body_laser, .range_sigma = 0.0};
  const PositionCovariance covariance = positionCovariance(mission, laser, kT_world_body, kP_laser);
  expectEqual(covariance.pose, spread([&] {
                const Vector6d error = normalVector6();
                const Pose moved{expRotation(0.004 * error.head<3>()) * kT_world_body.rotation,
                                 kT_world_body.translation + 0.02 * error.tail<3>()};
                return moved * (kT_body_laser * kP_laser);
              }));
  EXPECT_TRUE(covariance.random.isZero(0.0));
  EXPECT_TRUE(covariance.extrinsic.isZero(0.0));
}

TEST_F(PositionCovarianceOf, AllErrorsTogetherAddUp) {
  Mission mission;
  mission.pose_rotation_sigma = 0.003;
  mission.pose_translation_sigma = 0.01;
  Laser laser{.T_body_laser = kT_body_laser, .range_sigma = 0.02, .range_bias_sigma = 0.03};
  laser.covariance_body_laser = declaredExtrinsics();
  const Matrix6d root = laser.covariance_body_laser.llt().matrixL();
  const PositionCovariance covariance = positionCovariance(mission, laser, kT_world_body, kP_laser);
  expectEqual(covariance.total(), spread([&] {
                const double range = kP_laser.norm() + 0.02 * normal_(random_) + 0.03 * normal_(random_);
                const Vector6d mount = root * normalVector6();
                const Vector6d pose = normalVector6();
                const Pose T_body_laser{expRotation(mount.head<3>()) * kT_body_laser.rotation,
                                        kT_body_laser.translation + mount.tail<3>()};
                const Pose T_world_body{expRotation(0.003 * pose.head<3>()) * kT_world_body.rotation,
                                        kT_world_body.translation + 0.01 * pose.tail<3>()};
                return T_world_body * (T_body_laser * (range * kP_laser.normalized()));
              }));
}

TEST_F(PositionCovarianceOf, APerfectRigIsZero) {
  const PositionCovariance covariance =
      positionCovariance({}, Laser{.range_sigma = 0.0}, kT_world_body, kP_laser);
  EXPECT_TRUE(covariance.total().isZero(0.0));
}

}  // namespace
}  // namespace thermovox
