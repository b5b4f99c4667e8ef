#pragma once

#include <span>
#include <vector>

#include "mapping/hotspot.hpp"
#include "mapping/mission_report.hpp"
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
/// model of a hotter cluster explains goes to it. Optics, pixels and interpolation widen and lower a peak,
/// the more the further away, and the further off the surface's normal, the camera was: each sample is
/// compared with the model as its own view blurs it, so that the model is the peak itself. `frames`, where
/// given, tell where the camera was; otherwise it is taken to have faced the surface. Views at more than 65
/// degrees are left out where enough others are there. Where the fit fails the position is the mean of the
/// cells weighted by their excess, the peak that of the hottest cell, and the spot `reads_low`. Clusters of
/// fewer than three cells, and those that stand out by less than three sigmas, are no hot spots. Errors that
/// all measurements share are not in the result: see sharedCovariance.
[[nodiscard]] std::vector<Hotspot> findHotspots(const SurfaceLayer& layer, const HotspotCriteria& criteria,
                                                const CameraSharpness& camera,
                                                std::span<const FramePose> frames = {});

}  // namespace thermovox
