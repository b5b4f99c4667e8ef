#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration_input.hpp"
#include "calibration/laser_verdict.hpp"
#include "calibration/rig_bundle.hpp"

namespace thermovox {

struct CalibrationOptions {
  /// Hears what is being done and how much of it is (0 to 1); may be empty.
  std::function<void(const std::string& stage, double done)> progress;
};

/// What one camera turned out to be.
struct CameraVerdict {
  int views = 0;
  double rms_px = 0.0;         ///< root mean square distance of a corner that counts from its place
  double corner_factor = 1.0;  ///< what the corners' own sigmas had to be multiplied by
  int corners = 0, corner_outliers = 0;
  /// Of fx fy cx cy and the distortion coefficients the camera was given; rows of what was held are 0.
  /// Empty where nothing of it was estimated.
  Eigen::MatrixXd covariance_intrinsics;
  /// Of T_camera_reference: R' = Exp(w) R, t' = t + v along this camera's axes. Zero of the reference camera.
  Matrix6d covariance_pose = Matrix6d::Zero();
  bool pose_estimated = false;
};

/// A calibrated rig, and all that its report tells.
struct RigCalibration {
  RigEstimate estimate;
  std::vector<CameraVerdict> cameras;
  std::optional<LaserVerdict> laser;   ///< where there was a laser to calibrate
  double rms_mm = 0.0;                 ///< of the laser's returns about the boards' planes, along the ray
  double range_bias_sigma = 0.0;       ///< metres: what all ranges of a capture err by together
  BundleData data;                     ///< the observations that count
  std::vector<BoardCapture> captures;  ///< as the bundle took them: views turned to one side of the board
  std::vector<std::string> used;       ///< captures that count, by name
  std::vector<DroppedCapture> dropped;
  std::vector<std::string> warnings;
};

/// Calibrates cameras, their poses to each other, and the laser, together: one bundle of corners, board
/// planes and board edges. See calibration/README.md for the steps. A laser that the captures cannot
/// determine is no error: `laser->observable` is false and `laser->reason` says why. Throws ConfigError for
/// input that does not fit together, UnobservableError where the cameras cannot be determined.
[[nodiscard]] RigCalibration calibrateRig(const CalibrationInput& input, const CalibrationOptions& options);

}  // namespace thermovox
