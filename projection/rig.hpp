#pragma once

#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "projection/camera.hpp"
#include "projection/pose.hpp"
#include "projection/radiometry.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// A camera as it is mounted on the body.
struct MountedCamera {
  Camera camera;
  Pose T_body_camera;
  /// Of fx fy cx cy, then the distortion coefficients the camera was given; empty when the rig does not say.
  Eigen::MatrixXd covariance_intrinsics;
  /// Of T_body_camera: R' = Exp(w) R, t' = t + v along the body's axes. Zero when the rig does not say.
  Matrix6d covariance_body_camera = Matrix6d::Zero();
};

/// The thermal camera and what is known of its errors.
struct ThermalCamera {
  Camera camera;
  Pose T_body_camera;
  std::optional<TLinear> t_linear;  ///< of TIFFs of counts; without it they say themselves what they mean
  double netd = 0.05;               ///< noise of one pixel, one sigma, C
  double bias_sigma = 0.0;          ///< error common to a frame, one sigma, C (a Duo R is good to 5)
  double blur_px = 0.7;             ///< optics and pixel together, one sigma of a Gaussian, px
  bool knows_blur = false;          ///< whether the rig says so; otherwise blur_px is a guess
  /// Of fx fy cx cy, then the distortion coefficients the camera was given; empty when the rig does not say.
  Eigen::MatrixXd covariance_intrinsics;
};

enum class LaserKind { beam, scan, cloud };

/// A laser as it is mounted on the body, with its geometry and its noise.
struct Laser {
  LaserKind kind = LaserKind::beam;
  Pose T_body_laser;
  double range_min = 0.0;         ///< metres; shorter returns are dropped
  double range_max = 100.0;       ///< metres; longer returns are dropped
  double range_sigma = 0.02;      ///< noise of one range, one sigma, metres
  double range_bias_sigma = 0.0;  ///< error common to all readings, one sigma, metres
  /// Weaker returns are dropped; intensities may be negative (decibels).
  double min_intensity = -std::numeric_limits<double>::infinity();
  double angle_min = -0.75 * std::numbers::pi;      ///< scan: angle of the first range, radians
  double angle_increment = std::numbers::pi / 720;  ///< scan: radians from range to range
  Duration time_increment = Duration::zero();       ///< scan: time from range to range
  /// Of T_body_laser (the camera's pose is taken as exact, so this is the pair's): R' = Exp(w) R,
  /// t' = t + v, w and v along the body's axes. Zero when the rig does not say.
  Matrix6d covariance_body_laser = Matrix6d::Zero();
};

/// The sensors of a platform. A rig without thermal camera maps geometry only.
struct Rig {
  std::optional<ThermalCamera> thermal_camera;
  std::optional<MountedCamera> visible_camera;
  std::vector<Laser> lasers;
};

}  // namespace thermovox
