#pragma once

#include <Eigen/Core>
#include <cmath>

namespace thermovox {

template <typename T>
using Vec2 = Eigen::Matrix<T, 2, 1>;
template <typename T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

/// The lens models, with OpenCV's names for their coefficients.
enum class LensModel {
  pinhole,         ///< no distortion
  brown_conrady,   ///< k1 k2 p1 p2 [k3 [k4 k5 k6]]
  kannala_brandt,  ///< k1 k2 k3 k4 (OpenCV's fisheye)
};

/// Order of a camera's parameters in one array, as the calibrator varies them.
enum CameraParameter { kFx, kFy, kCx, kCy, kDistortion, kCameraParameters = kDistortion + 8 };

/// Brown-Conrady distortion of normalised coordinates (x, y) = (X / Z, Y / Z); d in OpenCV's order, unused
/// coefficients 0. Formula: OpenCV, "Camera Calibration and 3D Reconstruction"; D. C. Brown 1966.
template <typename T>
Vec2<T> distortBrownConrady(const T* d, const Vec2<T>& n) {
  const T& k1 = d[0];
  const T& k2 = d[1];
  const T& p1 = d[2];
  const T& p2 = d[3];
  const T& k3 = d[4];
  const T r2 = n.squaredNorm();
  const T xy = n.x() * n.y();
  const T radial = (T(1) + r2 * (k1 + r2 * (k2 + r2 * k3))) / (T(1) + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
  return {n.x() * radial + T(2) * p1 * xy + p2 * (r2 + T(2) * n.x() * n.x()),
          n.y() * radial + p1 * (r2 + T(2) * n.y() * n.y()) + T(2) * p2 * xy};
}

/// Kannala-Brandt distortion (the equidistant polynomial): theta_d = theta (1 + k1 theta^2 + ... + k4
/// theta^8) with theta = atan(r). Source: Kannala and Brandt 2006, as in OpenCV's fisheye module.
template <typename T>
Vec2<T> distortKannalaBrandt(const T* d, const Vec2<T>& n) {
  using std::atan;
  using std::sqrt;
  const T r2 = n.squaredNorm();
  if (r2 < T(1e-16)) return n;  // theta_d / r tends to 1
  const T r = sqrt(r2);
  const T theta = atan(r);
  const T t2 = theta * theta;
  const T theta_d = theta * (T(1) + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3]))));
  return n * (theta_d / r);
}

template <typename T>
Vec2<T> distort(LensModel model, const T* d, const Vec2<T>& n) {
  switch (model) {
    case LensModel::brown_conrady:
      return distortBrownConrady(d, n);
    case LensModel::kannala_brandt:
      return distortKannalaBrandt(d, n);
    case LensModel::pinhole:
      break;
  }
  return n;
}

/// The one projection formula of the project: the mapper calls it with double, the calibrator with
/// ceres::Jet, so both always agree. `parameters` has kCameraParameters entries. Camera frame: x right, y
/// down, z forward, metres; the pixel (0, 0) is the CENTRE of the top-left one. Precondition: z > 0.
/// Without distortion it is equation 1 of the paper: X = (u - cx) d / fx, Y = (v - cy) d / fy, Z = d.
template <typename T>
Vec2<T> pixelFromCamera(LensModel model, const T* parameters, const Vec3<T>& p_camera) {
  const Vec2<T> n = p_camera.template head<2>() / p_camera.z();
  const Vec2<T> distorted = distort(model, parameters + kDistortion, n);
  return {parameters[kFx] * distorted.x() + parameters[kCx],
          parameters[kFy] * distorted.y() + parameters[kCy]};
}

}  // namespace thermovox
