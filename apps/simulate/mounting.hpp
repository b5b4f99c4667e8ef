#pragma once

#include <Eigen/Geometry>
#include <initializer_list>
#include <numbers>

#include "projection/camera.hpp"

namespace thermovox::simulate {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// Turned about the body's x by roll, then y by pitch, then z by yaw; degrees.
[[nodiscard]] inline Eigen::Quaterniond rollPitchYaw(double roll_deg, double pitch_deg, double yaw_deg) {
  return (Eigen::AngleAxisd(yaw_deg * kDegree, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch_deg * kDegree, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_deg * kDegree, Eigen::Vector3d::UnitX()))
      .normalized();
}

/// R_body_camera of a camera that looks along the body's x: its x right, y down, z forward.
[[nodiscard]] inline Eigen::Quaterniond lookingAhead() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return Eigen::Quaterniond(R_body_camera);
}

[[nodiscard]] inline Intrinsics withDistortion(Intrinsics in, std::initializer_list<double> coefficients) {
  int i = kDistortion;
  for (const double coefficient : coefficients) in.parameters[i++] = coefficient;
  in.distortion_count = static_cast<int>(coefficients.size());
  return in;
}

}  // namespace thermovox::simulate
