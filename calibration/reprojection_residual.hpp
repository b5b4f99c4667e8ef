#pragma once

#include <Eigen/Geometry>

#include "projection/camera_model.hpp"

namespace thermovox {

/// p_a = T_a_b * p_b with the seven numbers of a pose, [qx qy qz qw tx ty tz].
template <typename T>
Vec3<T> transformBy(const T* T_a_b, const Vec3<T>& p_b) {
  const Eigen::Map<const Eigen::Quaternion<T>> q(T_a_b);
  const Eigen::Map<const Vec3<T>> t(T_a_b + 4);
  return q * p_b + t;
}

/// Where a corner of the board is in the image, against where it should be, in sigmas.
/// Blocks: T_reference_board [7], intrinsics [kCameraParameters] and, of a camera that is not the reference,
/// T_camera_reference [7]. Residual: 2.
struct ReprojectionResidual {
  LensModel model;
  Eigen::Vector3d p_board;    ///< metres
  Eigen::Vector2d pixel;      ///< observed
  Eigen::Matrix2d whitening;  ///< L with L^T L the inverse of the pixel's covariance, 1 / px

  template <typename T>
  bool operator()(const T* T_reference_board, const T* intrinsics, T* residual) const {
    return compare<T>(transformBy<T>(T_reference_board, p_board.cast<T>()), intrinsics, residual);
  }
  template <typename T>
  bool operator()(const T* T_reference_board, const T* intrinsics, const T* T_camera_reference,
                  T* residual) const {
    const Vec3<T> p_reference = transformBy<T>(T_reference_board, p_board.cast<T>());
    return compare<T>(transformBy<T>(T_camera_reference, p_reference), intrinsics, residual);
  }

 private:
  template <typename T>
  bool compare(const Vec3<T>& p_camera, const T* intrinsics, T* residual) const {
    if (!(p_camera.z() > T(1e-6))) return false;  // rejects the step; a residual of zero would reward it
    Eigen::Map<Vec2<T>> r(residual);
    r = whitening.cast<T>() * (pixelFromCamera<T>(model, intrinsics, p_camera) - pixel.cast<T>());
    return true;
  }
};

}  // namespace thermovox
