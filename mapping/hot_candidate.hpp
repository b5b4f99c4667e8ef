#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapping/hot_clusters.hpp"
#include "mapping/peak_model.hpp"
#include "mapping/surface_blur.hpp"
#include "mapping/surface_layer.hpp"

namespace thermovox {

/// A cluster on the way to a hot spot.
struct HotCandidate {
  HotCluster cells;
  LocalReference reference;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< weighted by the excess
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double spread2 = 0.0;  ///< mean squared distance from the centroid, m^2
  double weights = 0.0;  ///< effective number of cells
  double hottest = 0.0;
  std::optional<PeakFit> fit;
};

/// The peak that fits all samples around a cluster, hot or not, each as its own views blur it; not those of
/// other clusters (`hot`, by sample), far off the surface, seen from aside, or in doubt, where enough others
/// are there. The centre lies on the surface, which bends: it is sought again until it rests. What neighbours
/// share, and what a peak on a pipe was found to be off along it, is in the covariance. None where no peak
/// fits.
[[nodiscard]] std::optional<PeakFit> fitCandidate(const HotCandidate& candidate, const SurfaceLayer& layer,
                                                  const CameraSight& camera, const std::vector<bool>& hot);

/// Whether a candidate's fitted peak is where somebody looked, not beside what was measured of its flank.
[[nodiscard]] bool peakIsWithin(const HotCandidate& candidate, const SurfaceLayer& layer);

/// Of a cell's views, along its own surface; where that is not known, along the cluster's.
[[nodiscard]] SurfaceBlur blurOfCell(std::uint32_t sample, const HotCandidate& candidate,
                                     const SurfaceLayer& layer, const CameraSight& camera);

}  // namespace thermovox
