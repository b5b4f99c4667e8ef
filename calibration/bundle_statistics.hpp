#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/rig_bundle.hpp"

namespace thermovox {

/// The covariance of all unknowns by their information J^T J, and what of them the data do not determine.
struct JointCovariance {
  Eigen::MatrixXd covariance;  ///< in the order of the layout; empty where the information is singular
  double condition = 0.0;  ///< least over largest eigenvalue of the information, its columns scaled to one
};

[[nodiscard]] JointCovariance jointCovariance(const Linearisation& linear);

/// What the sigmas of some rows have to be multiplied by to explain how far off they are: the square root of
/// the sum of squares over what is left of their number, tr(I - J C J^T). 1 where too few are left.
template <typename Choose>
[[nodiscard]] double varianceFactor(const Linearisation& linear, const Eigen::MatrixXd& covariance,
                                    const Choose& chosen) {
  constexpr double kFewest = 4.0;
  double squares = 0.0, freedom = 0.0;
  for (const RowGroup& group : linear.groups) {
    if (!chosen(group)) continue;
    const Eigen::MatrixXd rows = linear.jacobian.middleRows(group.first, group.count);
    squares += linear.residuals.segment(group.first, group.count).squaredNorm();
    freedom += group.count - (rows * covariance).cwiseProduct(rows).sum();
  }
  return freedom < kFewest ? 1.0 : std::sqrt(squares / freedom);
}

/// The sigma of one capture's range bias that explains the captures best: the largest restricted likelihood,
/// with 5 mm within a factor of three as what is known before (metres). `fitted` is of the bundle with the
/// model's own sigma; `biases` are its estimates.
[[nodiscard]] double rangeBiasSigma(const Linearisation& fitted, const std::vector<double>& biases,
                                    double model_sigma);

}  // namespace thermovox
