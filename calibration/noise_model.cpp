#include "calibration/noise_model.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "calibration/bundle_statistics.hpp"

namespace thermovox {
namespace {

constexpr double kOutlier = 3.5;         // robust sigmas
constexpr double kLeastEdgeSigma = 0.3;  // of what crossings say: rays in a row may all pass well
constexpr int kRounds = 3;

/// The median size of residuals as the sigma of a Gaussian.
double robustSigma(std::vector<double> residuals) {
  for (double& residual : residuals) residual = std::abs(residual);
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return 1.4826 * *middle;
}

std::vector<double> residualsOf(const Linearisation& linear, RowGroup::Kind kind, int camera) {
  std::vector<double> residuals;
  for (const RowGroup& group : linear.groups) {
    if (group.kind != kind || group.camera != camera) continue;
    for (int row = group.first; row < group.first + group.count; ++row)
      residuals.push_back(linear.residuals[row]);
  }
  return residuals;
}

/// What the sides of the boards err by together, so that their offsets are as far off as expected: the root
/// of sum(m^2 / (v + sigma^2)) = n, with the offset m of a side and its variance v from its crossings alone.
double edgeOffsetSigma(const BundleData& data, const Linearisation& linear, const BundleModel& model) {
  constexpr double kMost = 0.05;                 // metres
  std::vector<std::pair<double, double>> sides;  // m^2, v
  for (const RowGroup& group : linear.groups) {
    if (group.kind != RowGroup::Kind::edges) continue;
    int row = group.first;
    for (const EdgeSide& side : data.captures[static_cast<std::size_t>(group.capture)].edges) {
      double weight = 0.0, along = 0.0;  // of r in the sigmas of the crossings, whitening undone
      for (const EdgeCrossing& crossing : side.crossings) {
        weight += 1.0 / (crossing.sigma * crossing.sigma);
        along += linear.residuals[row++] * model.edge_factor / crossing.sigma;
      }
      const double offset = std::hypot(side.offset_sigma, model.edge_offset_sigma / model.edge_factor);
      const double mean = along / weight * std::hypot(1.0, offset * std::sqrt(weight));
      const double own = 1.0 / weight + side.offset_sigma * side.offset_sigma;
      sides.emplace_back(mean * mean, model.edge_factor * model.edge_factor * own);
    }
  }
  constexpr double kUnknowns = 7.0;  // that the edges have a say in
  const double expected = static_cast<double>(sides.size()) - kUnknowns;
  const auto excess = [&](double sigma) {
    double sum = 0.0;
    for (const auto& [square, variance] : sides) sum += square / (variance + sigma * sigma);
    return sum - expected;
  };
  if (expected < 4.0 || excess(0.0) <= 2.0 * std::sqrt(2.0 * expected)) return 0.0;  // chance explains it
  double low = 0.0, high = kMost;
  while (high - low > 1e-6) (excess(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  return high;
}

/// Planes that do not fit although each fits its own returns: their factor, where chance does not explain it.
double planeFactor(const Linearisation& linear, const Eigen::MatrixXd& covariance, double now) {
  constexpr double kUnlikely = 0.05;
  double squares = 0.0, freedom = 0.0;
  for (RowGroup group : linear.groups) {
    if (group.kind != RowGroup::Kind::plane) continue;
    const Eigen::MatrixXd rows = linear.jacobian.middleRows(group.first, group.count);
    squares += linear.residuals.segment(group.first, group.count).squaredNorm();
    for (int row = 0; row < group.count; ++row) {
      if (rows.row(row).squaredNorm() > 0.0)
        freedom += 1.0 - rows.row(row) * covariance * rows.row(row).transpose();
    }
  }
  if (freedom < 4.0) return now;
  const double factor = now * std::sqrt(squares / freedom);
  const boost::math::chi_squared distribution(freedom);
  const bool chance =
      boost::math::cdf(boost::math::complement(distribution, factor * factor * freedom)) > kUnlikely;
  return chance ? 1.0 : std::max(1.0, factor);
}

}  // namespace

std::vector<int> dropCornerOutliers(BundleData& data, const RigEstimate& estimate, const BundleModel& model) {
  const Linearisation linear = linearise(data, estimate, model);
  std::vector<int> dropped(estimate.cameras.size(), 0);
  std::vector<double> gates;
  for (int camera = 0; camera < static_cast<int>(estimate.cameras.size()); ++camera) {
    const std::vector<double> residuals = residualsOf(linear, RowGroup::Kind::corners, camera);
    gates.push_back(residuals.empty() ? 0.0 : kOutlier * std::max(robustSigma(residuals), 1e-6));
  }
  for (const RowGroup& group : linear.groups) {
    if (group.kind != RowGroup::Kind::corners) continue;
    auto& corners = data.captures[static_cast<std::size_t>(group.capture)].corners;
    int row = group.first;
    const double gate = gates[static_cast<std::size_t>(group.camera)];
    const auto kept = std::remove_if(corners.begin(), corners.end(), [&](const CornerObservation& corner) {
      if (corner.camera != group.camera) return false;
      row += 2;
      return linear.residuals.segment<2>(row - 2).cwiseAbs().maxCoeff() > gate;
    });
    dropped[static_cast<std::size_t>(group.camera)] += static_cast<int>(corners.end() - kept);
    corners.erase(kept, corners.end());
  }
  return dropped;
}

int dropEdgeOutliers(BundleData& data, const RigEstimate& estimate, const BundleModel& model) {
  const Linearisation linear = linearise(data, estimate, model);
  const std::vector<double> residuals = residualsOf(linear, RowGroup::Kind::edges, -1);
  if (residuals.empty()) return 0;
  const double gate = kOutlier * std::max(robustSigma(residuals), kLeastEdgeSigma);
  int dropped = 0;
  for (const RowGroup& group : linear.groups) {
    if (group.kind != RowGroup::Kind::edges) continue;
    int row = group.first;
    for (EdgeSide& side : data.captures[static_cast<std::size_t>(group.capture)].edges) {
      const auto kept =
          std::remove_if(side.crossings.begin(), side.crossings.end(),
                         [&](const EdgeCrossing&) { return std::abs(linear.residuals[row++]) > gate; });
      dropped += static_cast<int>(side.crossings.end() - kept);
      side.crossings.erase(kept, side.crossings.end());
    }
    auto& sides = data.captures[static_cast<std::size_t>(group.capture)].edges;
    std::erase_if(sides, [](const EdgeSide& side) { return side.crossings.empty(); });
  }
  return dropped;
}

BundleFit fitWithNoise(const BundleData& data, const RigEstimate& start, BundleModel& model) {
  BundleFit fit = solveBundle(data, start, model);
  for (int round = 0; round < kRounds; ++round) {
    const Linearisation linear = linearise(data, fit.estimate, model);
    const Eigen::MatrixXd covariance = jointCovariance(linear).covariance;
    if (covariance.size() == 0) return fit;
    for (std::size_t camera = 0; camera < model.corner_factor.size(); ++camera) {
      model.corner_factor[camera] *= varianceFactor(linear, covariance, [&](const RowGroup& group) {
        return group.kind == RowGroup::Kind::corners && group.camera == static_cast<int>(camera);
      });
    }
    model.edge_factor *= varianceFactor(
        linear, covariance, [](const RowGroup& group) { return group.kind == RowGroup::Kind::edges; });
    if (linear.layout.laser >= 0) {
      model.edge_offset_sigma = edgeOffsetSigma(data, linear, model);
      model.range_bias_sigma = rangeBiasSigma(linear, fit.estimate.range_bias, model.range_bias_sigma);
      model.plane_factor = planeFactor(linear, covariance, model.plane_factor);
    }
    fit = solveBundle(data, fit.estimate, model);
  }
  return fit;
}

}  // namespace thermovox
