#pragma once

#include <vector>

#include "calibration/rig_bundle.hpp"

namespace thermovox {

/// Leaves out corners that are more than 3.5 robust sigmas off; how many of each camera.
std::vector<int> dropCornerOutliers(BundleData& data, const RigEstimate& estimate, const BundleModel& model);

/// The same for edges; how many.
int dropEdgeOutliers(BundleData& data, const RigEstimate& estimate, const BundleModel& model);

/// Fits the bundle and how far its measurements err, in turn: the corners of each camera, edges, ranges
/// beyond what their own scatter says, and the bias of a capture's ranges.
[[nodiscard]] BundleFit fitWithNoise(const BundleData& data, const RigEstimate& start, BundleModel& model);

}  // namespace thermovox
