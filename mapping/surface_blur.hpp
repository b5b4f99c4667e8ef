#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mapping/mission_report.hpp"
#include "mapping/surface_layer.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// How sharp a mission's camera saw, and from where.
struct CameraSight {
  double focal_px = 152.0;             ///< geometric mean of fx and fy
  double blur_px = 0.7;                ///< optics and pixel, one sigma
  double blur_sigma = 0.05;            ///< of the blur, as a share: a rig tells it with one or two digits
  double bias_sigma = 0.0;             ///< C, common to all temperatures
  std::optional<Camera> lens = {};     ///< where known: what a pixel covers off the axis
  std::vector<FramePose> frames = {};  ///< where known: places of the camera
};
/// A rig that does not know its blur has one between that of a pixel alone (0.29 px) and of a soft lens.
[[nodiscard]] CameraSight sightOf(const ThermalCamera& camera, std::vector<FramePose> frames = {});

/// Optics, pixel and linear interpolation between pixels, one sigma, px.
[[nodiscard]] double imageBlur(const CameraSight& camera);

/// How a view smears the temperatures of a surface: over it, by a Gaussian with the covariance
/// variance I + oblique oblique^T, m^2.
struct SurfaceBlur {
  double variance = 0.0;  ///< where it is least, m^2
  /// Along the surface, metres: what is seen at an angle is smeared further the way the view goes.
  Eigen::Vector3d oblique = Eigen::Vector3d::Zero();

  /// Whether the surface was seen from its front: at less than 65 degrees off its normal.
  [[nodiscard]] bool fromTheFront() const;
};

/// Of views in which the image moves by d pixel / d p_world (px / m, 2 x 3; at least one) along a surface
/// with the unit normal `normal` (sign arbitrary; zero: one that faces the camera). A blur of s px in the
/// image is one of s^2 (M^T M)^-1 on the surface, with M the derivative along it; of several views it is that
/// of the mean of M^T M, for temperatures count by their sigmas, which grow with the blur. Beyond 78 degrees
/// it is taken for 78.
[[nodiscard]] SurfaceBlur surfaceBlur(std::span<const Eigen::Matrix<double, 2, 3>> views,
                                      const Eigen::Vector3d& normal, double blur_px);

/// Of the views that a sample's temperatures are from: of one temperature the frame of its time that was as
/// far away as the sample's best view, of several all frames of their time that had it in their picture and
/// were no nearer. Without such frames it is taken for seen by a camera without distortion, straight on, as
/// far off the normal as the cell remembers, else along the normal.
[[nodiscard]] SurfaceBlur blurOf(const SurfaceSample& sample, const Eigen::Vector3d& normal,
                                 const CameraSight& camera);

}  // namespace thermovox
