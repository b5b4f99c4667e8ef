#pragma once

#include <vector>

#include "mapping/hotspot.hpp"
#include "mapping/surface_blur.hpp"
#include "mapping/surface_layer.hpp"

namespace thermovox {

/// The hot spots of one mission, the hottest first.
///
/// Cells that meet a criterion make clusters (hotClusters). Of each, a PeakModel is fitted to all samples
/// around, hot or not: its centre is the position, and, unlike a mean of the hot cells, does not move with
/// what of the spot was measured; a scanner's lines over one joint are pieces of one peak. A piece that the
/// model of a hotter cluster explains goes to it. Optics, pixels and interpolation widen and lower a peak,
/// the more the further away, and the further off the surface's normal, the camera was: each sample is
/// compared with the model as its own view blurs it, so that the model is the peak itself. Views that
/// are not from the surface's front are left out where enough others are there. Where the fit fails the
/// position is the mean of the cells weighted by their excess, the peak that of the hottest cell, and a
/// bound. Clusters of fewer than three cells, and those that stand out by less than three sigmas,
/// are no hot spots. Errors that all measurements share are not in the result: see sharedCovariance.
[[nodiscard]] std::vector<Hotspot> findHotspots(const SurfaceLayer& layer, const HotspotCriteria& criteria,
                                                const CameraSight& camera);

}  // namespace thermovox
