#pragma once

#include <vector>

#include "mapping/hotspot.hpp"
#include "mapping/surface_layer.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// What of the camera says how sharp a hot spot was seen.
struct CameraSharpness {
  double focal_px = 152.0;  ///< geometric mean of fx and fy
  double blur_px = 0.7;     ///< optics and pixel, one sigma
  double bias_sigma = 0.0;  ///< C, common to all temperatures
};
[[nodiscard]] CameraSharpness sharpnessOf(const ThermalCamera& camera);

/// The hot spots of one mission, the hottest first.
///
/// Cells that meet a criterion make clusters (hotClusters). Of each, a PeakModel is fitted to all samples
/// around, hot or not: its centre is the position, and, unlike a mean of the hot cells, does not move with
/// what of the spot was measured; a scanner's lines over one joint are pieces of one peak. A piece that the
/// model of a hotter cluster explains goes to it. Optics, pixels and interpolation widen a peak by a Gaussian
/// b and lower it: of its width w, w^2 - b^2 is its own, and the peak reads w^2 / (w^2 - b^2) times more over
/// its surroundings. Where the fit fails the position is the mean of the cells weighted by their excess, the
/// peak that of the hottest cell, and the spot `reads_low`. Clusters of fewer than three cells, and those
/// that stand out by less than three sigmas, are no hot spots. `common` errors are not in the result: see
/// addCommonErrors.
[[nodiscard]] std::vector<Hotspot> findHotspots(const SurfaceLayer& layer, const HotspotCriteria& criteria,
                                                const CameraSharpness& camera);

}  // namespace thermovox
