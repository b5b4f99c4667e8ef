#include "mapping/peak_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <random>

#include "projection/pose.hpp"

namespace thermovox {
namespace {

const PeakModel kTruth{.centre = {4.0, -2.0, 1.5}, .rise = 30.0, .width = 0.06, .reference = 21.0};
const Eigen::Vector3d kNormal = Eigen::Vector3d(0.2, -0.3, 0.9).normalized();
const Eigen::Vector3d kAlong = kNormal.unitOrthogonal();
const Eigen::Vector3d kAcross = kNormal.cross(kAlong);

/// A grid of 3 cm over 0.5 x 0.5 m of the plane, with noise.
std::vector<PeakSample> samplesOf(const PeakModel& model, double noise = 0.0, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<PeakSample> samples;
  for (int i = -8; i <= 8; ++i) {
    for (int j = -8; j <= 8; ++j) {
      const Eigen::Vector3d p = kTruth.centre + 0.03 * (i + 0.3) * kAlong + 0.03 * (j - 0.2) * kAcross;
      samples.push_back({p, model.at(p) + noise * normal(random), std::max(noise, 0.05)});
    }
  }
  return samples;
}

/// A guess as clusters give it: some centimetres and degrees off.
PeakPrior priorOf(const PeakModel& truth) {
  PeakPrior prior{.guess = truth, .normal = kNormal};
  prior.guess.centre += 0.02 * kAlong - 0.03 * kAcross;
  prior.guess.rise *= 0.8;
  prior.guess.width *= 1.3;
  prior.guess.reference += 0.5;
  return prior;
}

/// A prior that says next to nothing but where the surface is.
PeakPrior openPrior() {
  PeakPrior prior = priorOf(kTruth);
  prior.surface_sigma = 1e-6;
  prior.width_sigma = 1e3;
  prior.reference_sigma = 1e3;
  prior.model_error = 0.0;
  return prior;
}

TEST(PeakModel, IsAGaussianOverItsReference) {
  EXPECT_DOUBLE_EQ(kTruth.at(kTruth.centre), 51.0);
  EXPECT_NEAR(kTruth.at(kTruth.centre + 0.06 * kAlong), 21.0 + 30.0 * std::exp(-0.5), 1e-9);
  EXPECT_NEAR(kTruth.at(kTruth.centre + kAcross), 21.0, 1e-9);
}

const SurfaceBlur kBlurred{.variance = 4e-4, .oblique = 0.03 * kAlong};

TEST(PeakModel, ThroughABlurIsItsConvolution) {
  // The blur's own Gaussian over the surface, point by point.
  const double across = std::sqrt(kBlurred.variance), along = std::hypot(across, kBlurred.oblique.norm());
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.05, -0.03), Eigen::Vector2d(0.0, 0.1)}) {
    const Eigen::Vector3d p = kTruth.centre + at.x() * kAlong + at.y() * kAcross;
    double sum = 0.0, weights = 0.0;
    for (double u = -6.0; u <= 6.0; u += 0.1) {
      for (double v = -6.0; v <= 6.0; v += 0.1) {
        const double weight = std::exp(-0.5 * (u * u + v * v));
        sum += weight * kTruth.at(p + u * along * kAlong + v * across * kAcross);
        weights += weight;
      }
    }
    EXPECT_NEAR(kTruth.at(p, kBlurred), sum / weights, 1e-3);
  }
}

TEST(FitPeak, OfSamplesOfManyBlursIsThePeakBeforeThem) {
  std::vector<PeakSample> samples = samplesOf(kTruth);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    PeakSample& sample = samples[i];
    const double more = 0.5 * static_cast<double>(i % 5);
    sample.blur = {more * kBlurred.variance,
                   more * (i % 2 == 0 ? kBlurred.oblique : Eigen::Vector3d(0.02 * kAcross))};
    sample.celsius = kTruth.at(sample.p_world, sample.blur);
  }
  const auto fit = fitPeak(samples, openPrior());
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->model.centre - kTruth.centre).norm(), 1e-5);
  EXPECT_NEAR(fit->model.rise, kTruth.rise, 1e-3);
  EXPECT_NEAR(fit->model.width, kTruth.width, 1e-5);
}

TEST(FitPeak, HasTheErrorOfTheBlurThatAllSamplesShare) {
  std::vector<PeakSample> samples = samplesOf(kTruth), wider = samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].blur = kBlurred;
    wider[i].blur = {1.21 * kBlurred.variance, 1.1 * kBlurred.oblique};
    wider[i].celsius = samples[i].celsius = kTruth.at(samples[i].p_world, kBlurred);
  }
  PeakPrior prior = openPrior(), unsure = prior;
  prior.blur_sigma = 0.0;
  unsure.blur_sigma = 0.1;
  const auto fit = fitPeak(samples, prior), with_error = fitPeak(samples, unsure),
             moved = fitPeak(wider, prior);
  ASSERT_TRUE(fit && with_error && moved);
  const double by_blur = std::sqrt(with_error->covariance(3, 3) - fit->covariance(3, 3)) * kTruth.rise;
  EXPECT_NEAR(by_blur, moved->model.rise - fit->model.rise, 0.1 * by_blur);
  EXPECT_GT(by_blur, 0.5);
}

TEST(FitPeak, OfExactSamplesIsTheModel) {
  const auto fit = fitPeak(samplesOf(kTruth), openPrior());
  ASSERT_TRUE(fit);
  // The prior's pull on the centre, one in 1e7 of the samples' information, is what is left.
  EXPECT_LT((fit->model.centre - kTruth.centre).norm(), 1e-5);
  EXPECT_NEAR(fit->model.rise, kTruth.rise, 1e-3);
  EXPECT_NEAR(fit->model.width, kTruth.width, 1e-5);
  EXPECT_NEAR(fit->model.reference, kTruth.reference, 1e-3);
  EXPECT_LT(fit->misfit, 0.01);
}

TEST(FitPeak, AgreesWithTheClosedFormOfALogarithm) {
  // ln(T - reference) is a quadratic of the place: its coefficients give centre and width without a search
  // (Caruana et al., Analytical Chemistry 58, 1986).
  const std::vector<PeakSample> samples = samplesOf(kTruth);
  Eigen::MatrixXd terms(samples.size(), 4);
  Eigen::VectorXd logarithms(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d d = samples[i].p_world - kTruth.centre;
    const double u = kAlong.dot(d), v = kAcross.dot(d);
    terms.row(static_cast<Eigen::Index>(i)) << 1.0, u, v, u * u + v * v;
    logarithms[static_cast<Eigen::Index>(i)] = std::log(samples[i].celsius - kTruth.reference);
  }
  const Eigen::Vector4d c = terms.colPivHouseholderQr().solve(logarithms);
  const double width = std::sqrt(-0.5 / c[3]);
  const Eigen::Vector3d centre = kTruth.centre - 0.5 / c[3] * (c[1] * kAlong + c[2] * kAcross);
  const auto fit = fitPeak(samples, openPrior());
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->model.width, width, 1e-5);
  EXPECT_LT((fit->model.centre - centre).norm(), 1e-5);
}

/// The residuals as the header states them, written down once more: soft L1 of the samples, then the prior.
Eigen::VectorXd residualsOf(const std::vector<PeakSample>& samples, const PeakPrior& prior,
                            const Eigen::VectorXd& x) {
  const PeakModel model{x.head<3>(), std::exp(x[3]), std::exp(x[4]), x[5]};
  Eigen::VectorXd r(samples.size() + 5);
  Eigen::Index row = 0;
  for (const PeakSample& sample : samples) {
    const double sigma = std::hypot(sample.sigma, prior.model_error * prior.guess.rise);
    const double e = (model.at(sample.p_world, sample.blur) - sample.celsius) / sigma;
    r[row++] = std::copysign(std::sqrt(2.0 * (std::sqrt(1.0 + e * e) - 1.0)), e);
  }
  const Eigen::Vector3d moved = x.head<3>() - prior.guess.centre;
  r[row++] = kNormal.dot(moved) / prior.surface_sigma;
  r[row++] = kAlong.dot(moved) / (3.0 * prior.guess.width);
  r[row++] = kAcross.dot(moved) / (3.0 * prior.guess.width);
  r[row++] = (x[4] - std::log(prior.guess.width)) / prior.width_sigma;
  r[row++] = (x[5] - prior.guess.reference) / prior.reference_sigma;
  return r;
}

/// Central differences of the residuals.
Eigen::MatrixXd derivativesOf(const std::vector<PeakSample>& samples, const PeakPrior& prior,
                              const Eigen::VectorXd& x) {
  Eigen::MatrixXd derivatives(samples.size() + 5, 6);
  for (int i = 0; i < 6; ++i) {
    const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(6, i);
    derivatives.col(i) =
        (residualsOf(samples, prior, x + step) - residualsOf(samples, prior, x - step)) / 2e-6;
  }
  return derivatives;
}

TEST(FitPeak, IsALeastSquareWithTheCovarianceOfNumericDerivatives) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    SCOPED_TRACE(seed);
    std::vector<PeakSample> samples = samplesOf(kTruth, 0.4, seed);
    for (std::size_t i = 0; i < samples.size(); i += 2) {
      samples[i].blur = kBlurred;
      samples[i].celsius += kTruth.at(samples[i].p_world, kBlurred) - kTruth.at(samples[i].p_world);
    }
    PeakPrior prior = priorOf(kTruth);
    prior.blur_sigma = 0.0;
    const auto fit = fitPeak(samples, prior);
    ASSERT_TRUE(fit);
    Eigen::VectorXd x(6);
    x << fit->model.centre, std::log(fit->model.rise), std::log(fit->model.width), fit->model.reference;
    const Eigen::MatrixXd J = derivativesOf(samples, prior, x);
    const Eigen::VectorXd r = residualsOf(samples, prior, x);
    // At the least the gradient is zero: of each column's length times the residuals' it is some 1e-8.
    for (int i = 0; i < 6; ++i) {
      EXPECT_LT(std::abs(J.col(i).dot(r)), 1e-5 * J.col(i).norm() * r.norm()) << "parameter " << i;
    }
    const auto n = static_cast<Eigen::Index>(samples.size());
    const double chi2 = r.head(n).squaredNorm(), freedom = static_cast<double>(n) - 6.0;
    EXPECT_NEAR(fit->misfit, std::sqrt(chi2 / freedom), 1e-9);
    // The samples by their scatter, with five samples' weight on their own sigmas; the prior by its own.
    const double scale = (chi2 + 5.0) / (freedom + 5.0);
    const Eigen::MatrixXd known =
        J.topRows(n).transpose() * J.topRows(n) / scale + J.bottomRows(5).transpose() * J.bottomRows(5);
    const Eigen::MatrixXd covariance = known.inverse();
    EXPECT_LT((fit->independent - covariance).norm(), 1e-4 * covariance.norm());
  }
}

TEST(FitPeak, SaysHowFarItIsOff) {
  // 400 runs of three parameters: the mean of NEES per degree of freedom is good to 4 %.
  double in_plane = 0.0, rise = 0.0;
  constexpr int kRuns = 400;
  PeakPrior prior = openPrior();
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto fit = fitPeak(samplesOf(kTruth, 0.4, seed), prior);
    ASSERT_TRUE(fit);
    Eigen::Matrix<double, 3, 2> plane;
    plane << kAlong, kAcross;
    const Eigen::Vector2d off = plane.transpose() * (fit->model.centre - kTruth.centre);
    const Eigen::Matrix2d covariance = plane.transpose() * fit->covariance.topLeftCorner<3, 3>() * plane;
    in_plane += off.dot(covariance.inverse() * off) / 2.0 / kRuns;
    const double ln_rise = std::log(fit->model.rise / kTruth.rise);
    rise += ln_rise * ln_rise / fit->covariance(3, 3) / kRuns;
  }
  EXPECT_GT(in_plane, 0.65);
  EXPECT_LT(in_plane, 1.25);
  EXPECT_GT(rise, 0.65);
  EXPECT_LT(rise, 1.25);
}

TEST(FitPeak, DoesNotFollowAGlint) {
  std::vector<PeakSample> samples = samplesOf(kTruth, 0.2);
  for (const int i : {20, 21, 22}) samples[static_cast<std::size_t>(i)].celsius += 200.0;
  const auto fit = fitPeak(samples, priorOf(kTruth));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->model.centre - kTruth.centre).norm(), 0.004);
  EXPECT_NEAR(fit->model.rise, kTruth.rise, 2.0);
}

TEST(FitPeak, FindsWhereAPeakOfHalfItsSamplesIs) {
  // What the laser did not see of it does not move its centre.
  std::vector<PeakSample> samples = samplesOf(kTruth, 0.2);
  std::erase_if(samples, [](const PeakSample& s) { return kAlong.dot(s.p_world - kTruth.centre) > 0.015; });
  const auto fit = fitPeak(samples, priorOf(kTruth));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->model.centre - kTruth.centre).norm(), 0.006);
}

TEST(FitPeak, WithoutANormalStaysNearItsGuess) {
  PeakPrior prior = priorOf(kTruth);
  prior.normal.setZero();
  const auto fit = fitPeak(samplesOf(kTruth, 0.2), prior);
  ASSERT_TRUE(fit);
  // Off the plane nothing is known: the error there is within its own sigma, and that is wide.
  const Eigen::Vector3d off = fit->model.centre - kTruth.centre;
  const Eigen::Matrix3d covariance = fit->covariance.topLeftCorner<3, 3>();
  EXPECT_LT(off.dot(covariance.inverse() * off), 16.0);
  EXPECT_LT((off - off.dot(kNormal) * kNormal).norm(), 0.01);
}

TEST(FitPeak, RefusesWhatIsNoPeak) {
  std::vector<PeakSample> ramp = samplesOf(kTruth);
  for (PeakSample& s : ramp) s.celsius = 20.0 + 60.0 * kAlong.dot(s.p_world - kTruth.centre);
  EXPECT_FALSE(fitPeak(ramp, priorOf(kTruth)));
  PeakPrior narrow = priorOf(kTruth);
  narrow.guess.width = kTruth.width / 4.0;  // which is another thing than was guessed
  narrow.width_sigma = 100.0;
  EXPECT_FALSE(fitPeak(samplesOf(kTruth), narrow));
}

TEST(FitPeak, IsTheSameEveryTime) {
  const std::vector<PeakSample> samples = samplesOf(kTruth, 0.4);
  const auto a = fitPeak(samples, priorOf(kTruth)), b = fitPeak(samples, priorOf(kTruth));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->model.centre, b->model.centre);
  EXPECT_EQ(a->covariance, b->covariance);
}

}  // namespace
}  // namespace thermovox
