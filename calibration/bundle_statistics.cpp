#include "calibration/bundle_statistics.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace thermovox {
namespace {

Eigen::MatrixXd informationOf(const Linearisation& linear) {
  const Eigen::SparseMatrix<double> information = linear.jacobian.transpose() * linear.jacobian;
  return information;
}

/// All unknowns but the biases eliminated from information and gradient of the bundle.
struct BiasInformation {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

BiasInformation eliminated(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                           const std::vector<Eigen::Index>& biases) {
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    if (std::find(biases.begin(), biases.end(), i) == biases.end()) others.push_back(i);
  }
  const Eigen::MatrixXd across = information(others, biases);
  const Eigen::LDLT<Eigen::MatrixXd> rest(Eigen::MatrixXd(information(others, others)));
  return {information(biases, biases) - across.transpose() * rest.solve(across),
          gradient(biases) - across.transpose() * rest.solve(Eigen::VectorXd(gradient(others)))};
}

}  // namespace

JointCovariance jointCovariance(const Linearisation& linear) {
  constexpr double kSingular = 1e-13;
  JointCovariance joint;
  if (linear.jacobian.cols() == 0) return joint;
  const Eigen::MatrixXd information = informationOf(linear);
  const Eigen::VectorXd scale =
      information.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 1.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      Eigen::MatrixXd(scale.asDiagonal() * information * scale.asDiagonal()));
  const Eigen::VectorXd& values = eigen.eigenvalues();
  joint.condition = values[0] / values[values.size() - 1];
  if (!(joint.condition > kSingular)) return joint;
  const Eigen::MatrixXd vectors = scale.asDiagonal() * eigen.eigenvectors();
  joint.covariance = vectors * values.cwiseInverse().asDiagonal() * vectors.transpose();
  return joint;
}

double rangeBiasSigma(const Linearisation& fitted, const std::vector<double>& biases, double model_sigma) {
  constexpr double kUsual = 0.005, kFactor = 3.0;              // metres, what is known before
  constexpr double kLeast = 0.0002, kMost = 0.1, kStep = 1.1;  // metres
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < biases.size(); ++i) {
    if (fitted.layout.range_bias[i] >= 0) places.push_back(fitted.layout.range_bias[i]);
  }
  Eigen::MatrixXd information = informationOf(fitted);
  Eigen::VectorXd gradient = fitted.jacobian.transpose() * fitted.residuals;
  Eigen::VectorXd values(places.size());
  const double weight = 1.0 / (model_sigma * model_sigma);
  for (std::size_t i = 0, k = 0; i < biases.size(); ++i) {  // without the priors they were found with
    const int place = fitted.layout.range_bias[i];
    if (place < 0) continue;
    values[static_cast<Eigen::Index>(k++)] = biases[i];
    information(place, place) -= weight;
    gradient[place] -= weight * biases[i];
  }
  const BiasInformation free = eliminated(information, gradient, places);
  double best = model_sigma, least = std::numeric_limits<double>::infinity();
  for (double sigma = kLeast; sigma < kMost; sigma *= kStep) {
    const double prior = 1.0 / (sigma * sigma);
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(free.information +
                                            prior * Eigen::MatrixXd::Identity(values.size(), values.size()));
    if (!(ldlt.vectorD().minCoeff() > 0.0)) continue;
    const Eigen::VectorXd slope = free.gradient + prior * values;
    const double cost = prior * values.squaredNorm() - slope.dot(ldlt.solve(slope)) +
                        ldlt.vectorD().array().log().sum() +
                        2.0 * static_cast<double>(values.size()) * std::log(sigma) +
                        std::pow(std::log(sigma / kUsual) / std::log(kFactor), 2);
    if (!(cost < least)) continue;
    least = cost;
    best = sigma;
  }
  return best;
}

}  // namespace thermovox
