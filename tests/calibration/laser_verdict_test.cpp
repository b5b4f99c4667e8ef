#include "calibration/laser_verdict.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "calibration/bundle_statistics.hpp"
#include "tests/calibration/calibration_scene.hpp"
#include "tests/calibration/moved_estimate.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

/// A bundle at its solution, and the verdict on it.
struct Judged {
  BundleScene scene;
  BundleFit fit;
  Linearisation linear;
  Eigen::MatrixXd covariance;
  LaserVerdict verdict;
};

Judged judged(BundleScene scene) {
  Judged result{.scene = std::move(scene), .fit = {}, .linear = {}, .covariance = {}, .verdict = {}};
  const BundleScene& s = result.scene;
  result.fit = solveBundle(s.data, s.truth, s.model);
  result.linear = linearise(s.data, result.fit.estimate, s.model);
  result.covariance = jointCovariance(result.linear).covariance;
  result.verdict = laserVerdict(result.linear, result.covariance, result.fit.estimate,
                                {.kind = s.kind,
                                 .free_intrinsics = s.model.free_intrinsics.front(),
                                 .captures = static_cast<int>(s.captures)});
  return result;
}

BundleScene sceneOf(LaserKind kind) {
  return made({.kind = kind,
               .captures = kind == LaserKind::beam ? std::size_t{30} : std::size_t{16},
               .corner_sigma_px = 0.1,
               .range_sigma = 0.005,
               .range_bias_sigma = 0.005,
               .seed = 1});
}

TEST(LaserVerdict, OfABeamHasRankFive) {
  const Judged beam = judged(sceneOf(LaserKind::beam));
  EXPECT_TRUE(beam.verdict.observable);
  EXPECT_FALSE(beam.verdict.roll_observable);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(beam.verdict.covariance);
  EXPECT_LT(std::abs(eigen.eigenvalues()[0]), 1e-9 * eigen.eigenvalues()[5]);
  EXPECT_GT(eigen.eigenvalues()[1], 1e-7 * eigen.eigenvalues()[5]);
  Vector6d roll = Vector6d::Zero();
  roll.head<3>() = beam.fit.estimate.T_reference_laser.rotation * Eigen::Vector3d::UnitX();
  EXPECT_LT((beam.verdict.covariance * roll).norm(), 1e-12);
}

TEST(LaserVerdict, OfScanAndCloudHasTheBundlesCovarianceInTheCamerasAxes) {
  for (const LaserKind kind : {LaserKind::scan, LaserKind::cloud}) {
    const Judged result = judged(sceneOf(kind));
    EXPECT_TRUE(result.verdict.roll_observable);
    // R Exp(w) = Exp(R w) R: the laser's tangent turned into the camera.
    Matrix6d turned = Matrix6d::Identity();
    turned.topLeftCorner<3, 3>() = result.fit.estimate.T_reference_laser.matrix();
    const Matrix6d expected = turned * result.covariance.topLeftCorner<6, 6>() * turned.transpose();
    const double inflation =
        result.verdict.jackknife_wins ? std::pow(result.verdict.jackknife_ratio, 2) : 1.0;
    EXPECT_THAT(result.verdict.covariance, IsNear(inflation * expected, 1e-9 * expected.norm()));
  }
}

TEST(LaserVerdict, KnowsItsWeakestDirection) {
  const Judged result = judged(sceneOf(LaserKind::scan));
  const Vector6d& weakest = result.verdict.weakest;
  const Matrix6d covariance =
      result.verdict.covariance /
      (result.verdict.jackknife_wins ? std::pow(result.verdict.jackknife_ratio, 2) : 1.0);
  EXPECT_NEAR(weakest.dot(covariance.inverse() * weakest), 1.0, 1e-6) << "one sigma";
  Vector6d shares = weakest;
  shares.head<3>() /= 0.2 * kDegree;
  shares.tail<3>() /= 0.005;
  EXPECT_NEAR(shares.norm(), result.verdict.weakest_share, 1e-9);
  EXPECT_GT(result.verdict.condition, 1.0);
}

/// The root of the mean square by which a laser's point misses its pixel, by drawing lasers and lenses.
double drawnTransfer(const Judged& judged, double distance) {
  const Eigen::MatrixXd L = Eigen::LLT<Eigen::MatrixXd>(judged.covariance).matrixL();
  const Eigen::Vector3d p = distance * Eigen::Vector3d::UnitX();
  const auto pixelOf = [&](const RigEstimate& estimate) {
    const Intrinsics& lens = estimate.cameras.front();
    return pixelFromCamera<double>(lens.model, lens.parameters.data(), estimate.T_reference_laser * p);
  };
  const Eigen::Vector2d middle = pixelOf(judged.fit.estimate);
  Chance chance(2);
  double squares = 0.0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    Eigen::VectorXd deviates(L.rows());
    for (double& deviate : deviates) deviate = chance.normal();
    const RigEstimate drawn =
        movedBy(judged.fit.estimate, judged.linear.layout, L * deviates, judged.scene.model);
    squares += (pixelOf(drawn) - middle).squaredNorm() / kDraws;
  }
  return std::sqrt(squares);
}

TEST(LaserVerdict, TransfersToPixelsAsWellAsDrawnLasersAndLensesDo) {
  const Judged beam = judged(sceneOf(LaserKind::beam));
  ASSERT_EQ(beam.verdict.transfer.size(), 3U);
  for (const PixelTransfer& transfer : beam.verdict.transfer) {
    // 4000 draws of about one degree of freedom: four standard errors are 4.5 per cent.
    const double drawn = drawnTransfer(beam, transfer.distance);
    EXPECT_NEAR(transfer.sigma_px, drawn, 0.06 * drawn) << transfer.distance << " m";
  }
}

TEST(LaserVerdict, LeavesCapturesOutOneAtATime) {
  const Judged all = judged(sceneOf(LaserKind::cloud));
  const auto n = static_cast<double>(all.scene.captures);
  std::vector<Vector6d> moves;
  Vector6d mean = Vector6d::Zero();
  for (std::size_t out = 0; out < all.scene.captures; ++out) {
    BundleScene rest = all.scene;
    rest.data.captures[out] = {};
    const Pose laser = solveBundle(rest.data, all.fit.estimate, rest.model).estimate.T_reference_laser;
    const Eigen::AngleAxisd turn(all.fit.estimate.T_reference_laser.rotation.conjugate() * laser.rotation);
    Vector6d move;
    move << turn.angle() * turn.axis(), laser.translation - all.fit.estimate.T_reference_laser.translation;
    moves.push_back(move);
    mean += move / n;
  }
  Vector6d squares = Vector6d::Zero();
  for (const Vector6d& move : moves) squares += (move - mean).cwiseAbs2();
  const Vector6d sigmas = ((n - 1.0) / n * squares).cwiseSqrt();
  const double ratio = (sigmas.array() / all.covariance.diagonal().head<6>().array().sqrt()).maxCoeff();
  // One step of Gauss and Newton for the whole bundle anew: what is left of curvature is a per cent.
  EXPECT_NEAR(all.verdict.jackknife_ratio, ratio, 0.03 * ratio);
}

TEST(LaserVerdict, MakesItsCovarianceAsLargeAsCapturesScatter) {
  BundleScene scene = sceneOf(LaserKind::cloud);
  const Judged sound = judged(scene);
  EXPECT_FALSE(sound.verdict.jackknife_wins);
  scene.model.range_bias_sigma = 0.0003;  // 5 mm, and nobody says so
  const Judged blind = judged(scene);
  ASSERT_TRUE(blind.verdict.jackknife_wins);
  ASSERT_GT(blind.verdict.jackknife_ratio, 2.0);
  const double bundle = blind.covariance.topLeftCorner<6, 6>().trace();
  EXPECT_NEAR(blind.verdict.covariance.trace(), bundle * std::pow(blind.verdict.jackknife_ratio, 2),
              1e-6 * bundle);
}

}  // namespace
}  // namespace thermovox::test
