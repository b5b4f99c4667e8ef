#pragma once

#include <vector>

#include "calibration/rig_bundle.hpp"

namespace thermovox {

/// Which captures the laser is calibrated from, and the bundle with these.
struct CaptureSelection {
  BundleFit fit;
  double range_bias_sigma = 0.0;  ///< metres: as the captures that count scatter
  std::vector<bool> counts;       ///< of each capture of the data
  /// Of each capture with a plane: how likely noise alone would put its plane as far off. 1 without a plane.
  std::vector<double> probability;
};

/// Parts captures whose laser saw another board than the cameras (it moved in between) from the others. The
/// least fitting two fifths are left out, then the best fitting of those come back one at a time, as long as
/// their planes are as the bundle without them expects (chi-square, at 2.5e-4); how much the ranges of a
/// capture err together is estimated anew each time (a forward search: Atkinson and Riani 2000). `start` should
/// explain most captures.
[[nodiscard]] CaptureSelection selectCaptures(const BundleData& data, const RigEstimate& start,
                                              BundleModel model);

/// The data without the planes and edges of the captures that do not count.
[[nodiscard]] BundleData onlyCounting(const BundleData& data, const std::vector<bool>& counts);

}  // namespace thermovox
