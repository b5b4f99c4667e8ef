#include "calibration/capture_selection.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/bundle_statistics.hpp"

namespace thermovox {
namespace {

constexpr double kUnlikely = 2.5e-4;
constexpr double kLeastKept = 0.6;  // of the captures, at first

/// How well each capture fits, if noise is as the model says: of the ones in the fit without themselves.
std::vector<double> probabilities(const BundleData& data, const CaptureSelection& selection,
                                  const BundleModel& model) {
  Linearisation linear = linearise(data, selection.fit.estimate, model);
  Linearisation counting = linear;
  for (const RowGroup& group : linear.groups) {
    if (group.capture < 0 || selection.counts[static_cast<std::size_t>(group.capture)]) continue;
    if (group.kind != RowGroup::Kind::plane && group.kind != RowGroup::Kind::edges) continue;
    // The prior of the bias, the last row of a plane, stays: it is all that is known of that bias.
    const int silent = group.kind == RowGroup::Kind::plane ? group.count - 1 : group.count;
    for (int row = group.first; row < group.first + silent; ++row) {
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(counting.jacobian, row); it; ++it)
        it.valueRef() = 0.0;
    }
  }
  const Eigen::MatrixXd covariance = jointCovariance(counting).covariance;
  std::vector<double> result(data.captures.size(), 1.0);
  if (covariance.size() == 0) return result;
  for (const RowGroup& group : linear.groups) {
    if (group.kind != RowGroup::Kind::plane) continue;
    const auto capture = static_cast<std::size_t>(group.capture);
    RowGroup ranges = group;
    if (!selection.counts[capture]) --ranges.count;  // its prior is in the covariance
    const GroupTest test = selection.counts[capture] ? testWithin(linear, ranges, covariance)
                                                     : testBeside(linear, ranges, covariance);
    result[capture] = test.probability();
  }
  return result;
}

/// The bundle with the captures that count, its sigma of the biases, and how likely every capture is.
void refit(const BundleData& data, CaptureSelection& selection, BundleModel& model) {
  const BundleData counting = onlyCounting(data, selection.counts);
  for (std::size_t i = 0; i < selection.counts.size(); ++i) {
    if (!selection.counts[i]) selection.fit.estimate.range_bias[i] = 0.0;
  }
  for (int round = 0; round < 2; ++round) {
    selection.fit = solveBundle(counting, selection.fit.estimate, model);
    const Linearisation linear = linearise(counting, selection.fit.estimate, model);
    model.range_bias_sigma =
        rangeBiasSigma(linear, selection.fit.estimate.range_bias, model.range_bias_sigma);
  }
  selection.range_bias_sigma = model.range_bias_sigma;
  selection.probability = probabilities(data, selection, model);
}

/// The capture that fits least (of those that count) or best (of those that do not); none where there is none.
std::optional<std::size_t> extreme(const BundleData& data, const CaptureSelection& selection, bool counting) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < data.captures.size(); ++i) {
    if (!data.captures[i].plane || selection.counts[i] != counting) continue;
    if (!found || (counting ? selection.probability[i] < selection.probability[*found]
                            : selection.probability[i] > selection.probability[*found]))
      found = i;
  }
  return found;
}

}  // namespace

BundleData onlyCounting(const BundleData& data, const std::vector<bool>& counts) {
  BundleData counting = data;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i]) continue;
    counting.captures[i].plane.reset();
    counting.captures[i].edges.clear();
  }
  return counting;
}

CaptureSelection selectCaptures(const BundleData& data, const RigEstimate& start, BundleModel model) {
  CaptureSelection selection;
  selection.fit.estimate = start;
  std::size_t planes = 0;
  for (const CaptureObservations& capture : data.captures) {
    selection.counts.push_back(capture.plane.has_value());
    planes += capture.plane ? 1 : 0;
  }
  refit(data, selection, model);
  const auto least = static_cast<std::size_t>(std::ceil(kLeastKept * static_cast<double>(planes)));
  for (std::size_t kept = planes; kept > std::max<std::size_t>(least, 6); --kept) {
    const std::optional<std::size_t> worst = extreme(data, selection, true);
    if (!worst) break;
    selection.counts[*worst] = false;
    refit(data, selection, model);
  }
  while (const std::optional<std::size_t> best = extreme(data, selection, false)) {
    if (selection.probability[*best] < kUnlikely) break;
    selection.counts[*best] = true;
    refit(data, selection, model);
  }
  return selection;
}

}  // namespace thermovox
