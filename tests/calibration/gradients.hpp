#pragma once

#include <ceres/autodiff_cost_function.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <vector>

#include "calibration/pose_manifold.hpp"
#include "projection/pose.hpp"

namespace thermovox::test {

/// The seven numbers of a pose as Ceres varies them.
inline std::vector<double> blockOf(const Pose& pose) {
  const auto& q = pose.rotation.coeffs();
  const auto& t = pose.translation;
  return {q[0], q[1], q[2], q[3], t[0], t[1], t[2]};
}

/// Whether a residual's derivatives are those of finite differences, each block varied by its manifold (null:
/// as it is). A correct residual of a quaternion fails at 1e-6, the worst error was 1.1e-5, by the finite
/// differences; COLMAP checks to 1e-4, and so do we. What finite differences of
/// a quaternion err by (3e-6 of the largest derivative) is much of an entry that is small: all are allowed
/// 1e-5 of the largest of their block.
inline testing::AssertionResult hasItsGradient(const ceres::CostFunction& cost,
                                               const std::vector<std::vector<double>>& blocks,
                                               const std::vector<const ceres::Manifold*>& manifolds) {
  constexpr double kRelative = 1e-4, kSmall = 1e-5;
  const ceres::GradientChecker checker(&cost, &manifolds, ceres::NumericDiffOptions());
  std::vector<const double*> parameters;
  for (const std::vector<double>& block : blocks) parameters.push_back(block.data());
  ceres::GradientChecker::ProbeResults results;
  if (checker.Probe(parameters.data(), kRelative, &results)) return testing::AssertionSuccess();
  if (!results.return_value) return testing::AssertionFailure() << "cannot be evaluated";
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const auto &exact = results.local_jacobians[block], &numeric = results.local_numeric_jacobians[block];
    const auto off = (exact - numeric).cwiseAbs().array();
    const double small = kSmall * numeric.cwiseAbs().maxCoeff();
    if ((off > kRelative * numeric.cwiseAbs().array() + small).any())
      return testing::AssertionFailure() << "block " << block << ": " << results.error_log;
  }
  return testing::AssertionSuccess();
}

}  // namespace thermovox::test
