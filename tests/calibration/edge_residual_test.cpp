#include "calibration/edge_residual.hpp"

#include <ceres/dynamic_autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/calibration/gradients.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

Eigen::VectorXd residualOf(const EdgeResidual& functor, const Pose& board, const Pose& laser, double bias) {
  const std::vector<double> a = blockOf(board), b = blockOf(laser);
  const std::array<const double*, 3> blocks{a.data(), b.data(), &bias};
  Eigen::VectorXd r(static_cast<Eigen::Index>(functor.side.crossings.size()));
  EXPECT_TRUE(functor(blocks.data(), r.data()));
  return r;
}

class EdgeResidualTest : public testing::Test {
 protected:
  EdgeResidualTest() : scene_(made({.captures = 1, .edges = BundleScene::Edges::exact})) {}
  [[nodiscard]] const Pose& board() const { return scene_.truth.T_reference_board.front(); }
  [[nodiscard]] const Pose& laser() const { return scene_.truth.T_reference_laser; }
  [[nodiscard]] std::vector<EdgeSide> sides() const { return scene_.data.captures.front().edges; }

  BundleScene scene_;
};

TEST_F(EdgeResidualTest, IsZeroOnTheEdge) {
  for (const EdgeSide& side : sides())
    EXPECT_LT(residualOf({side, 1.0}, board(), laser(), 0.0).norm(), 1e-10);
}

TEST_F(EdgeResidualTest, IsPositiveWhereTheRayPassesOutsideWhicheverTheSide) {
  for (EdgeSide side : sides()) {
    side.offset_sigma = 0.0;
    for (EdgeCrossing& crossing : side.crossings) crossing.place *= 0.98;  // the rays pass outside of it
    EXPECT_GT(residualOf({side, 1.0}, board(), laser(), 0.0).minCoeff(), 0.0);
  }
}

TEST_F(EdgeResidualTest, IsExplainedByAPlateThatSeemsLarger) {
  for (EdgeSide side : sides()) {
    for (EdgeCrossing& crossing : side.crossings) crossing.place -= crossing.place > 0.0 ? 0.004 : -0.004;
    EXPECT_LT(residualOf({side, 1.0}, board(), laser(), 0.004).norm(), 1e-10);
  }
}

TEST_F(EdgeResidualTest, IsWhitenedByTheCovarianceOfACommonOffset) {
  Chance chance(1);
  for (EdgeSide side : sides()) {
    for (EdgeCrossing& crossing : side.crossings) {
      crossing.sigma = chance.uniform(0.001, 0.01);
      crossing.place += chance.normal(0.005);
    }
    side.offset_sigma = 0.0;
    const auto n = static_cast<Eigen::Index>(side.crossings.size());
    Eigen::VectorXd off = residualOf({side, 1.0}, board(), laser(), 0.0), sigmas(n);
    for (Eigen::Index i = 0; i < n; ++i) sigmas[i] = side.crossings[static_cast<std::size_t>(i)].sigma;
    off = off.cwiseProduct(sigmas).eval();  // metres
    for (const double offset : {0.0, 0.002, 0.02}) {
      for (const double factor : {1.0, 2.5}) {
        side.offset_sigma = offset;
        const Eigen::MatrixXd covariance =
            Eigen::MatrixXd(sigmas.cwiseAbs2().asDiagonal()) + offset * offset * Eigen::MatrixXd::Ones(n, n);
        const double expected =
            off.dot(Eigen::LLT<Eigen::MatrixXd>(covariance).solve(off)) / (factor * factor);
        const Eigen::VectorXd r = residualOf({side, factor}, board(), laser(), 0.0);
        EXPECT_NEAR(r.squaredNorm(), expected, 1e-10 * expected);
      }
    }
  }
}

TEST_F(EdgeResidualTest, HasItsGradient) {
  const PoseManifold board_manifold;
  const LaserManifold laser_manifold;
  Chance chance(2);
  for (const EdgeSide& side : sides()) {
    ceres::DynamicAutoDiffCostFunction<EdgeResidual, 15> cost(new EdgeResidual{side, 1.5});
    for (const int size : {7, 7, 1}) cost.AddParameterBlock(size);
    cost.SetNumResiduals(static_cast<int>(side.crossings.size()));
    EXPECT_TRUE(hasItsGradient(cost, {blockOf(moved(board(), chance, 0.02, 0.02)), blockOf(laser()), {0.003}},
                               {&board_manifold, &laser_manifold, nullptr}));
  }
}

TEST_F(EdgeResidualTest, RefusesABoardSeenFromBehindOrAlong) {
  const double no_bias = 0.0;
  const std::vector<double> turned = blockOf(
                                {board().rotation * expRotation({3.1, 0.0, 0.0}), board().translation}),
                            at = blockOf(laser());
  const std::array<const double*, 3> blocks{turned.data(), at.data(), &no_bias};
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  EXPECT_FALSE((EdgeResidual{sides().front(), 1.0}(blocks.data(), r.data())));
}

}  // namespace
}  // namespace thermovox::test
