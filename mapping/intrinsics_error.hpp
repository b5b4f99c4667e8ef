#pragma once

#include <Eigen/Core>
#include <span>

#include "mapping/hotspot.hpp"
#include "mapping/mission_report.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Covariance (world, m^2) of a hot spot's place that the errors of the camera's intrinsics cause, as the rig
/// declares them; zero where it does not, or where no frame had the spot in its picture.
///
/// Wrong by dp, the intrinsics K put what a pixel saw where the surface is seen in that pixel now: it moves
/// along the surface by -(d pixel / d surface)^-1 (d pixel / d K) dp. That is taken in the spot's best frame,
/// and where that is not known in the frame that would move it most; frames that had it elsewhere in their
/// picture would move it otherwise, and their mean less.
[[nodiscard]] Eigen::Matrix3d intrinsicsCovariance(const Hotspot& spot, std::span<const FramePose> frames,
                                                   const ThermalCamera& camera);

}  // namespace thermovox
