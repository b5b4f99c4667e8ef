#include "calibration/bundle_statistics.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

/// A made-up problem: random rows, residuals of this sigma.
Linearisation randomProblem(int rows, int columns, double sigma, std::uint64_t seed) {
  Chance chance(seed);
  Eigen::MatrixXd J(rows, columns);
  for (double& value : J.reshaped()) value = chance.normal();
  Linearisation linear;
  linear.jacobian = J.sparseView();
  linear.residuals.resize(rows);
  for (double& value : linear.residuals) value = chance.normal(sigma);
  linear.residuals -= J * J.colPivHouseholderQr().solve(linear.residuals);  // at the least squares
  linear.layout.size = columns;
  for (int first = 0; first < rows; first += 10)
    linear.groups.push_back({.kind = first % 20 == 0 ? RowGroup::Kind::corners : RowGroup::Kind::plane,
                             .first = first,
                             .count = std::min(10, rows - first)});
  return linear;
}

constexpr auto kAll = [](const RowGroup&) { return true; };

TEST(JointCovariance, IsTheInverseOfTheInformation) {
  Linearisation linear = randomProblem(60, 8, 1.0, 1);
  for (int i = 0; i < 8; ++i) linear.jacobian.col(i) *= std::pow(10.0, i - 4);  // units differ
  const Eigen::MatrixXd J = linear.jacobian;
  const JointCovariance joint = jointCovariance(linear);
  const Eigen::MatrixXd inverse = (J.transpose() * J).fullPivLu().inverse();
  ASSERT_EQ(joint.covariance.rows(), 8);
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k) {
      const double scale = std::sqrt(inverse(i, i) * inverse(k, k));
      EXPECT_NEAR(joint.covariance(i, k) / scale, inverse(i, k) / scale, 1e-7);
    }
  }
  EXPECT_GT(joint.condition, 1e-3) << "whatever the units";
}

TEST(JointCovariance, IsEmptyWhereSomethingIsNotDetermined) {
  Linearisation linear = randomProblem(60, 8, 1.0, 2);
  Eigen::MatrixXd J = linear.jacobian;
  J.col(3) = J.col(5) - 2.0 * J.col(1);
  linear.jacobian = J.sparseView();
  EXPECT_EQ(jointCovariance(linear).covariance.size(), 0);
  J.col(3).setZero();
  linear.jacobian = J.sparseView();
  EXPECT_EQ(jointCovariance(linear).covariance.size(), 0);
  EXPECT_EQ(jointCovariance(Linearisation{}).covariance.size(), 0);
}

TEST(JointCovariance, IsOfTheBundleWhatItsErrorsAre) {
  BundleScene scene = made({.captures = 8, .corner_sigma_px = 0.1, .range_sigma = 0.005, .seed = 3});
  const Linearisation linear = linearise(scene.data, scene.truth, scene.model);
  const Eigen::MatrixXd J = linear.jacobian;
  const Eigen::MatrixXd covariance = jointCovariance(linear).covariance;
  ASSERT_EQ(covariance.rows(), linear.layout.size);
  // Of a condition of about 1e8 eight digits are left.
  EXPECT_LT((J * covariance * J.transpose() * J - J).norm(), 1e-6 * J.norm());
}

TEST(VarianceFactor, IsTheSigmaOfTheResiduals) {
  const Linearisation linear = randomProblem(2000, 12, 2.0, 4);
  const Eigen::MatrixXd covariance = jointCovariance(linear).covariance;
  // Four standard errors of 2000 numbers, and of the half of them that are corners.
  EXPECT_NEAR(varianceFactor(linear, covariance, kAll), 2.0, 2.0 * 4.0 / std::sqrt(2.0 * 1988.0));
  const auto corners = [](const RowGroup& group) { return group.kind == RowGroup::Kind::corners; };
  EXPECT_NEAR(varianceFactor(linear, covariance, corners), 2.0, 2.0 * 4.0 / std::sqrt(2.0 * 994.0));
}

TEST(VarianceFactor, CountsWhatTheUnknownsTook) {
  // 30 rows for 20 unknowns: without their number the mean over many problems would be sqrt(1/3).
  double squares = 0.0;
  constexpr int kProblems = 200;
  for (int i = 0; i < kProblems; ++i) {
    const Linearisation linear = randomProblem(30, 20, 1.0, 100 + static_cast<std::uint64_t>(i));
    squares += std::pow(varianceFactor(linear, jointCovariance(linear).covariance, kAll), 2);
  }
  EXPECT_NEAR(squares / kProblems, 1.0, 4.0 * std::sqrt(2.0 / (10.0 * kProblems)));
}

TEST(VarianceFactor, IsOneWhereTooLittleIsLeft) {
  const Linearisation linear = randomProblem(12, 10, 3.0, 5);
  EXPECT_EQ(varianceFactor(linear, jointCovariance(linear).covariance, kAll), 1.0);
  const auto none = [](const RowGroup&) { return false; };
  EXPECT_EQ(varianceFactor(linear, jointCovariance(linear).covariance, none), 1.0);
}

/// What rangeBiasSigma makes of captures with biases of `sigma`, as a geometric mean over some sets of them.
double meanBiasSigma(LaserKind kind, double sigma, int sets) {
  double logs = 0.0;
  for (int i = 0; i < sets; ++i) {
    BundleScene scene = made({.kind = kind,
                              .captures = 24,
                              .corner_sigma_px = 0.05,
                              .range_sigma = 0.005,
                              .range_bias_sigma = sigma,
                              .seed = 40 + static_cast<std::uint64_t>(i)});
    for (int round = 0; round < 3; ++round) {
      const BundleFit fit = solveBundle(scene.data, scene.truth, scene.model);
      scene.model.range_bias_sigma = rangeBiasSigma(linearise(scene.data, fit.estimate, scene.model),
                                                    fit.estimate.range_bias, scene.model.range_bias_sigma);
    }
    logs += std::log(scene.model.range_bias_sigma) / sets;
  }
  return std::exp(logs);
}

TEST(RangeBiasSigma, IsThatOfTheCaptures) {
  constexpr int kSets = 8;
  for (const double sigma : {0.002, 0.008}) {
    // Of 24 captures with 6 unknowns 18 numbers are left: 17 per cent a set, three standard errors of the
    // mean; what is known before (5 mm within three) pulls by 2 per cent, the steps of the search are 10.
    const double error = 3.0 * 0.17 / std::sqrt(kSets) + 0.05;
    EXPECT_NEAR(std::log(meanBiasSigma(LaserKind::cloud, sigma, kSets) / sigma), 0.0, error) << sigma;
  }
}

TEST(RangeBiasSigma, DoesNotDependOnWhereItBegan) {
  const BundleScene scene = made(
      {.captures = 16, .corner_sigma_px = 0.05, .range_sigma = 0.005, .range_bias_sigma = 0.006, .seed = 6});
  std::vector<double> found;
  for (const double model_sigma : {0.001, 0.005, 0.03}) {
    BundleModel model = scene.model;
    model.range_bias_sigma = model_sigma;
    const BundleFit fit = solveBundle(scene.data, scene.truth, model);
    found.push_back(
        rangeBiasSigma(linearise(scene.data, fit.estimate, model), fit.estimate.range_bias, model_sigma));
  }
  // The prior it was fitted with is taken out again; the search goes in steps of a tenth.
  EXPECT_NEAR(found[1] / found[0], 1.0, 0.11);
  EXPECT_NEAR(found[2] / found[0], 1.0, 0.11);
}

}  // namespace
}  // namespace thermovox::test
