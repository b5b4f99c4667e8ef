#pragma once

#include <Eigen/Core>
#include <vector>

#include "apps/simulate/capture_scene.hpp"
#include "calibration/edge_residual.hpp"

namespace thermovox::bench {

/// What one capture measures, as far as the bound asks.
struct MeasuredCapture {
  Pose T_reference_board;             ///< the truth
  std::vector<Eigen::Vector3d> rays;  ///< unit, laser frame: those that meet the plate
  std::vector<EdgeSide> edges;        ///< crossings with their covariance; may be none
};

/// A set-up whose Cramer-Rao bound is asked for. The reference camera is the thermal one.
struct MeasuredSetUp {
  std::vector<Intrinsics> cameras;  ///< thermal, and the visible one if it is used
  std::vector<Pose> T_camera_reference;
  std::vector<Eigen::Vector3d> points;  ///< of the board
  std::vector<double> corner_sigma_px;  ///< of each camera
  LaserKind laser = LaserKind::cloud;
  Pose T_reference_laser;
  double range_sigma = 0.0;       ///< metres
  double range_bias_sigma = 0.0;  ///< of a capture, metres; 0: there is none
  std::vector<MeasuredCapture> captures;
};

/// The least covariance of T_reference_laser (rotation along the reference's axes, rad; translation, m) that
/// any unbiased estimator can have which does not know lenses, boards and biases: the inverse of the Fisher
/// information, by numeric derivatives of what the instruments would measure. Of a beam the roll's row and
/// column are those of its pseudo-inverse. It shares the projection with the estimator, nothing else.
[[nodiscard]] Matrix6d cramerRaoBound(const MeasuredSetUp& set_up);

}  // namespace thermovox::bench
