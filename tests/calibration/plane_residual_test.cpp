#include "calibration/plane_residual.hpp"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/calibration/gradients.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

TEST(InversePlane, GivesTheRangeOfEveryRay) {
  const Pose laser = laserBesideCamera();
  for (const Pose& board : boardsHeld(20, 1)) {
    const Eigen::Vector3d q = inversePlane<double>(blockOf(board).data(), blockOf(laser).data());
    for (const Eigen::Vector3d& p_board :
         {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.2, -0.1, 0.0), Eigen::Vector3d(-0.3, 0.2, 0.0)}) {
      const Eigen::Vector3d p_laser = laser.inverse() * (board * p_board);
      EXPECT_NEAR(1.0 / q.dot(p_laser.normalized()), p_laser.norm(), 1e-12);
    }
  }
}

TEST(PlaneResidual, IsZeroWhereTheBoardReallyIs) {
  const BundleScene scene = made({.captures = 5});
  const double no_bias = 0.0;
  for (std::size_t i = 0; i < scene.captures; ++i) {
    ASSERT_TRUE(scene.data.captures[i].plane);
    Eigen::Vector4d r = Eigen::Vector4d::Zero();
    ASSERT_TRUE(PlaneResidual{*scene.data.captures[i].plane}(blockOf(scene.truth.T_reference_board[i]).data(),
                                                             blockOf(scene.truth.T_reference_laser).data(),
                                                             &no_bias, r.data()));
    EXPECT_LT(r.norm(), 1e-7);  // sigmas of 1e-3 m over some thousand rays: rounding of 1e-15 m is 1e-10
  }
}

TEST(PlaneResidual, CountsRangesThatAreTooLongAsANegativeBias) {
  Chance chance(2);
  const BundleScene scene = made({.captures = 1});
  ReturnSet returns;
  for (const Eigen::Vector3d& ray : raysOf(LaserKind::cloud)) {
    if (const auto range = rangeOfPlate(ray, scene.laserFromBoard(0), scene.board))
      returns.emplace_back((*range + 0.004) * ray);
  }
  const auto moments = planeMoments(returns, LaserKind::cloud, 0.002);
  ASSERT_TRUE(moments);
  const auto normOf = [&](double bias) {
    Eigen::Vector4d r = Eigen::Vector4d::Zero();
    EXPECT_TRUE(PlaneResidual{*moments}(blockOf(scene.truth.T_reference_board[0]).data(),
                                        blockOf(scene.truth.T_reference_laser).data(), &bias, r.data()));
    return r.norm();
  };
  // To second order: 4 mm at 1 m leave (0.004)^2 m, a hundredth of a sigma a ray, of some hundred rays.
  EXPECT_LT(normOf(-0.004), 0.01 * normOf(0.0));
  EXPECT_GT(normOf(0.004), 1.9 * normOf(0.0));
}

TEST(PlaneResidual, HasItsGradientForEveryKindOfLaser) {
  const PoseManifold board_manifold;
  const LaserManifold laser_manifold;
  const BeamManifold beam_manifold;
  Chance chance(3);
  for (const LaserKind kind : {LaserKind::beam, LaserKind::scan, LaserKind::cloud}) {
    const BundleScene scene = made({.kind = kind, .captures = 5, .range_sigma = 0.005});
    const ceres::Manifold* laser = &laser_manifold;
    if (kind == LaserKind::beam) laser = &beam_manifold;
    for (std::size_t i = 0; i < scene.captures; ++i) {
      ASSERT_TRUE(scene.data.captures[i].plane);
      const ceres::AutoDiffCostFunction<PlaneResidual, 4, 7, 7, 1> cost(
          new PlaneResidual{*scene.data.captures[i].plane});
      EXPECT_TRUE(hasItsGradient(cost,
                                 {blockOf(moved(scene.truth.T_reference_board[i], chance, 0.02, 0.02)),
                                  blockOf(scene.truth.T_reference_laser),
                                  {0.003}},
                                 {&board_manifold, laser, nullptr}));
    }
  }
}

TEST(PlaneResidual, RefusesALaserThatLiesInTheBoard) {
  const BundleScene scene = made({.captures = 1});
  const double no_bias = 0.0;
  Eigen::Vector4d r = Eigen::Vector4d::Zero();
  EXPECT_FALSE(PlaneResidual{*scene.data.captures[0].plane}(blockOf(scene.truth.T_reference_board[0]).data(),
                                                            blockOf(scene.truth.T_reference_board[0]).data(),
                                                            &no_bias, r.data()));
}

}  // namespace
}  // namespace thermovox::test
