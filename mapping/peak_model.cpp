#include "mapping/peak_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/NonLinearOptimization>

#include "mapping/plane_basis.hpp"

namespace thermovox {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
constexpr int kPriors = 5;  // rows of what is known before
constexpr Eigen::Index kSectors = 6;
constexpr double kByChance = 0.5;  // by which the widest of twelve scores of independent errors are too wide
constexpr double kSmallSample = 2.0 * kSectors / (2.0 * kSectors - 1.0);  // of few scores
constexpr double kTrust = 5.0;  // samples that the sigmas' own word stands for against the scatter

using Scores = Eigen::Matrix<double, 6, 2 * kSectors>;

PeakModel modelOf(const Eigen::VectorXd& x) {
  return {x.head<3>(), std::exp(x[3]), std::exp(x[4]), x[5]};
}

/// A residual whose square is the soft L1 loss 2 (sqrt(1 + r^2) - 1), with its derivative. Written without
/// that difference, in which a small r would be lost.
struct SoftResidual {
  double value, slope;
};
SoftResidual soft(double r) {
  const double root = std::sqrt(1.0 + r * r);
  return {r * std::sqrt(2.0 / (root + 1.0)), std::sqrt((root + 1.0) / 2.0) / root};
}

/// A model's temperature at a place through a blur, and its derivatives.
struct BlurredPeak {
  double rise;                ///< over the reference, C; also its derivative by ln rise
  Eigen::Vector3d by_centre;  ///< C / m
  double by_width;            ///< by ln width, C
  double by_blur;             ///< by the logarithm of the blur's width, C
};

/// With o the blur's oblique part, a = width^2 + variance and b = a + o^2 are the eigenvalues of C along the
/// surface, and C^-1 = (I - o o^T / b) / a (Sherman and Morrison 1950).
BlurredPeak blurredPeak(const PeakModel& model, const Eigen::Vector3d& p_world, const SurfaceBlur& blur) {
  const Eigen::Vector3d d = p_world - model.centre;
  const double w2 = model.width * model.width, o2 = blur.oblique.squaredNorm();
  const double a = w2 + blur.variance, b = a + o2, ab = a * b;
  const double d2 = d.squaredNorm(), od = blur.oblique.dot(d), od2 = od * od;
  const double rise = model.rise * w2 / std::sqrt(ab) * std::exp(-0.5 * (d2 / a - od2 / ab));
  const double stretched = od2 * (a + b) / (ab * ab);  // of od2 / ab, by a and b together
  const double by_width = 2.0 - w2 / a - w2 / b + w2 * (d2 / (a * a) - stretched);
  const double by_blur = -blur.variance / a - (blur.variance + o2) / b +
                         blur.variance * (d2 / (a * a) - stretched) + od2 / ab - o2 * od2 * a / (ab * ab);
  return {rise, rise * (d / a - blur.oblique * od / ab), rise * by_width, rise * by_blur};
}

/// For Eigen's solver: residuals in sigmas, and their derivatives by centre, ln rise, ln width, reference.
struct PeakProblem {
  std::span<const PeakSample> samples;
  const PeakPrior& prior;
  Eigen::Vector3d along, across;  ///< the surface's plane
  double scale;                   ///< of the model's error, C

  [[nodiscard]] int values() const { return static_cast<int>(samples.size()) + kPriors; }
  [[nodiscard]] double sigmaOf(const PeakSample& sample) const { return std::hypot(sample.sigma, scale); }

  /// Of a sample's residual by the model's temperature there.
  [[nodiscard]] double slopeAt(const PeakSample& sample, double celsius) const {
    return soft((celsius - sample.celsius) / sigmaOf(sample)).slope / sigmaOf(sample);
  }
  /// Of all residuals by the logarithm of the blur's width.
  [[nodiscard]] Eigen::VectorXd byBlur(const PeakModel& model) const {
    Eigen::VectorXd derivative(samples.size());
    Eigen::Index row = 0;
    for (const PeakSample& sample : samples) {
      const BlurredPeak peak = blurredPeak(model, sample.p_world, sample.blur);
      derivative[row++] = slopeAt(sample, model.reference + peak.rise) * peak.by_blur;
    }
    return derivative;
  }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
    const PeakModel model = modelOf(x);
    Eigen::Index row = 0;
    for (const PeakSample& sample : samples) {
      residuals[row++] =
          soft((model.at(sample.p_world, sample.blur) - sample.celsius) / sigmaOf(sample)).value;
    }
    const Eigen::Vector3d moved = x.head<3>() - prior.guess.centre;
    residuals[row++] = prior.normal.dot(moved) / prior.surface_sigma;
    residuals[row++] = along.dot(moved) / (3.0 * prior.guess.width);
    residuals[row++] = across.dot(moved) / (3.0 * prior.guess.width);
    residuals[row++] = (x[4] - std::log(prior.guess.width)) / prior.width_sigma;
    residuals[row++] = (x[5] - prior.guess.reference) / prior.reference_sigma;
    return 0;
  }

  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& jacobian) const {
    const PeakModel model = modelOf(x);
    jacobian.setZero();
    Eigen::Index row = 0;
    for (const PeakSample& sample : samples) {
      const BlurredPeak peak = blurredPeak(model, sample.p_world, sample.blur);
      const double slope = slopeAt(sample, model.reference + peak.rise);
      jacobian.block<1, 3>(row, 0) = slope * peak.by_centre.transpose();
      jacobian(row, 3) = slope * peak.rise;
      jacobian(row, 4) = slope * peak.by_width;
      jacobian(row, 5) = slope;
      ++row;
    }
    jacobian.block<1, 3>(row++, 0) = prior.normal.transpose() / prior.surface_sigma;
    jacobian.block<1, 3>(row++, 0) = along.transpose() / (3.0 * prior.guess.width);
    jacobian.block<1, 3>(row++, 0) = across.transpose() / (3.0 * prior.guess.width);
    jacobian(row++, 4) = 1.0 / prior.width_sigma;
    jacobian(row++, 5) = 1.0 / prior.reference_sigma;
    return 0;
  }
};

/// Of all samples in a sector about the centre, near or far, the sum of their gradients J^T r, one column
/// each.
Scores scoresOf(const PeakProblem& problem, const PeakModel& model, const Eigen::MatrixXd& jacobian,
                const Eigen::VectorXd& residuals) {
  Scores scores = Scores::Zero();
  Eigen::Index row = 0;
  for (const PeakSample& sample : problem.samples) {
    const Eigen::Vector3d d = sample.p_world - model.centre;
    const double turn =
        std::atan2(problem.across.dot(d), problem.along.dot(d)) / (2.0 * std::numbers::pi) + 0.5;
    const auto sector = std::min(static_cast<Eigen::Index>(turn * kSectors), kSectors - 1);
    const Eigen::Index ring = d.norm() < 1.2 * model.width ? 0 : kSectors;
    scores.col(sector + ring) += residuals[row] * jacobian.row(row).transpose();
    ++row;
  }
  return scores;
}

/// Errors that neighbours share - the edge of something nearer, another shape than the model's - do not
/// average out as those of single samples do. Their covariance is that of the sectors' scores S (the sandwich
/// of Liang and Zeger 1986), C S S^T C with C that of independent errors; where it is wider than that by more
/// than chance makes it, it counts.
Matrix6d widened(const Matrix6d& independent, const Scores& scores) {
  const Eigen::LLT<Matrix6d> root(independent);
  const Eigen::Matrix<double, 6, 2 * kSectors> whitened = root.matrixL().transpose() * scores;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(kSmallSample * whitened * whitened.transpose());
  const Matrix6d back = root.matrixL() * axes.eigenvectors();
  return back * (axes.eigenvalues().array() - kByChance).cwiseMax(1.0).matrix().asDiagonal() *
         back.transpose();
}

PeakProblem problemOf(std::span<const PeakSample> samples, const PeakPrior& prior) {
  const Eigen::Matrix<double, 3, 2> plane = planeBasis(prior.normal);
  return {samples, prior, plane.col(0), plane.col(1), prior.model_error * prior.guess.rise};
}

}  // namespace

double PeakModel::at(const Eigen::Vector3d& p_world, const SurfaceBlur& blur) const {
  return reference + blurredPeak(*this, p_world, blur).rise;
}

std::optional<PeakFit> fitPeak(std::span<const PeakSample> samples, const PeakPrior& given) {
  PeakPrior prior = given;
  if (prior.normal.isZero()) {  // nothing is known along z either, but that it is near
    prior.normal = Eigen::Vector3d::UnitZ();
    prior.surface_sigma = 3.0 * prior.guess.width;
  }
  PeakProblem problem = problemOf(samples, prior);
  Eigen::VectorXd x(6);
  x << prior.guess.centre, std::log(prior.guess.rise), std::log(prior.guess.width), prior.guess.reference;
  Eigen::LevenbergMarquardt<PeakProblem> solver(problem);
  const auto status = solver.minimize(x);
  if (status <= 0 || status == Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation || !x.allFinite()) {
    return std::nullopt;
  }
  PeakFit fit{modelOf(x), {}, {}, 0.0};
  const double growth = fit.model.width / prior.guess.width;
  if ((fit.model.centre - prior.guess.centre).norm() > 4.0 * prior.guess.width || !(growth > 1.0 / 3.0) ||
      !(growth < 3.0)) {
    return std::nullopt;
  }
  Eigen::MatrixXd jacobian(problem.values(), 6);
  problem.df(x, jacobian);
  Eigen::VectorXd residuals(problem.values());
  problem(x, residuals);
  const auto n = static_cast<Eigen::Index>(samples.size());
  const double freedom = std::max(static_cast<double>(n) - 6.0, 1.0);
  const double chi2 = residuals.head(n).squaredNorm();
  fit.misfit = std::sqrt(chi2 / freedom);
  // The scale of a variance by scatter and prior (scaled inverse chi squared). The surface's height is not
  // known by temperatures: what is known before keeps its own scale.
  const double scale = (chi2 + kTrust) / (freedom + kTrust);
  Eigen::Matrix<double, 6, 6> known = jacobian.topRows(n).transpose() * jacobian.topRows(n) / scale;
  known += jacobian.bottomRows(kPriors).transpose() * jacobian.bottomRows(kPriors);
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> information(known);
  if (information.info() != Eigen::Success || !information.isPositive()) return std::nullopt;
  fit.independent = information.solve(Matrix6d::Identity());
  fit.covariance = widened(fit.independent, scoresOf(problem, fit.model, jacobian, residuals) / scale);
  const Vector6d by_blur =
      information.solve(jacobian.topRows(n).transpose() * problem.byBlur(fit.model)) / scale;
  const Matrix6d blur = prior.blur_sigma * prior.blur_sigma * by_blur * by_blur.transpose();
  fit.independent += blur;
  fit.covariance += blur;
  return fit;
}

}  // namespace thermovox
