#pragma once

#include <Eigen/Core>
#include <cmath>
#include <type_traits>

#include "projection/cpu_level.hpp"

namespace thermovox {

template <typename T>
using Vec2 = Eigen::Matrix<T, 2, 1>;
template <typename T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

/// Two coordinates, or a symmetric 2 x 2 matrix, as bare numbers: a loop over many of them becomes vector
/// instructions, which it does not with matrices in it. The formulas below are written for these.
template <typename T>
struct Coordinates2 {
  T x, y;
};
template <typename T>
struct Symmetric2 {
  T xx, xy, yy;
};

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
THERMOVOX_INLINE_LOOP Coordinates2<T> distortBrownConrady(const T* d, const T& x, const T& y) {
  const T& p1 = d[2];
  const T& p2 = d[3];
  const T r2 = x * x + y * y;
  const T xy = x * y;
  const T radial =
      (T(1) + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (T(1) + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
  return {x * radial + T(2) * p1 * xy + p2 * (r2 + T(2) * x * x),
          y * radial + p1 * (r2 + T(2) * y * y) + T(2) * p2 * xy};
}

/// Its derivative by (x, y), which is symmetric.
template <typename T>
THERMOVOX_INLINE_LOOP Symmetric2<T> brownConradyJacobian(const T* d, const T& x, const T& y) {
  const T s = x * x + y * y;
  const T denominator = T(1) + s * (d[5] + s * (d[6] + s * d[7]));
  const T radial = (T(1) + s * (d[0] + s * (d[1] + s * d[4]))) / denominator;
  const T numerator_slope = d[0] + s * (T(2) * d[1] + T(3) * s * d[4]);
  const T denominator_slope = d[5] + s * (T(2) * d[6] + T(3) * s * d[7]);
  const T radial_slope = (numerator_slope - radial * denominator_slope) / denominator;  // d radial / d s
  const T& p1 = d[2];
  const T& p2 = d[3];
  return {radial + T(2) * x * x * radial_slope + T(2) * p1 * y + T(6) * p2 * x,
          T(2) * x * y * radial_slope + T(2) * p1 * x + T(2) * p2 * y,
          radial + T(2) * y * y * radial_slope + T(6) * p1 * y + T(2) * p2 * x};
}

/// atan(r) for r >= 0 and types of derivatives; for plain numbers in arithmetic alone, to 2 units in the last
/// place: the C library's own differs between processors in the last bit, and does not become vector
/// instructions. Reduction and rational approximation: S. L. Moshier, Cephes (netlib), atan.c.
template <typename T>
THERMOVOX_INLINE_LOOP T arcTangent(const T& r) {
  if constexpr (std::is_floating_point_v<T>) {
    const bool far = r > T(2.414213562373095);  // tan(3 pi / 8)
    const bool middle = r > T(0.66);
    const T numerator = far ? T(-1) : middle ? r - T(1) : r;
    const T denominator = far ? r : middle ? r + T(1) : T(1);
    const T offset = far ? T(1.5707963267948966) : middle ? T(0.7853981633974483) : T(0);
    const T rest = far ? T(6.123233995736766e-17) : middle ? T(3.061616997868383e-17) : T(0);
    const T x = numerator / denominator;
    const T z = x * x;
    const T p = (((T(-8.750608600031904122785e-1) * z + T(-1.615753718733365076637e1)) * z +
                  T(-7.500855792314704667340e1)) *
                     z +
                 T(-1.228866684490136173410e2)) *
                    z +
                T(-6.485021904942025371773e1);
    const T q = ((((z + T(2.485846490142306297962e1)) * z + T(1.650270098316988542046e2)) * z +
                  T(4.328810604912902668951e2)) *
                     z +
                 T(4.853903996359136964868e2)) *
                    z +
                T(1.945506571482613964425e2);
    return offset + (x * (z * p / q) + (x + rest));
  } else {
    using std::atan;
    return atan(r);
  }
}

/// Kannala-Brandt distortion (the equidistant polynomial): theta_d = theta (1 + k1 theta^2 + ... + k4
/// theta^8) with theta = atan(r). Source: Kannala and Brandt 2006, as in OpenCV's fisheye module.
template <typename T>
THERMOVOX_INLINE_LOOP Coordinates2<T> distortKannalaBrandt(const T* d, const T& x, const T& y) {
  using std::sqrt;
  const T r2 = x * x + y * y;
  const bool center = r2 < T(1e-16);  // theta_d / r tends to 1
  const T r = sqrt(center ? T(1) : r2);
  const T theta = arcTangent(r);
  const T t2 = theta * theta;
  const T theta_d = theta * (T(1) + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3]))));
  const T ratio = theta_d / r;
  const T scale = center ? T(1) : ratio;
  return {x * scale, y * scale};
}

/// Its derivative by (x, y), which is symmetric.
template <typename T>
THERMOVOX_INLINE_LOOP Symmetric2<T> kannalaBrandtJacobian(const T* d, const T& x, const T& y) {
  using std::sqrt;
  const T r2 = x * x + y * y;
  const bool center = r2 < T(1e-16);
  const T squared = center ? T(1) : r2;
  const T r = sqrt(squared);
  const T theta = arcTangent(r);
  const T t2 = theta * theta;
  const T theta_d = theta * (T(1) + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3]))));
  const T slope = T(1) + t2 * (T(3) * d[0] + t2 * (T(5) * d[1] + t2 * (T(7) * d[2] + t2 * T(9) * d[3])));
  const T along = slope / (T(1) + squared);
  const T across = theta_d / r;
  const T turning = (along - across) / squared;
  const T at_center = center ? T(1) : across;
  const T around = center ? T(0) : turning;
  return {at_center + around * x * x, around * x * y, at_center + around * y * y};
}

/// Distortion by a model that is known when compiling, and its derivative.
template <LensModel kModel, typename T>
THERMOVOX_INLINE_LOOP Coordinates2<T> distortBy(const T* d, const T& x, const T& y) {
  if constexpr (kModel == LensModel::brown_conrady) return distortBrownConrady(d, x, y);
  if constexpr (kModel == LensModel::kannala_brandt) return distortKannalaBrandt(d, x, y);
  return {x, y};
}
template <LensModel kModel, typename T>
THERMOVOX_INLINE_LOOP Symmetric2<T> distortionJacobianBy(const T* d, const T& x, const T& y) {
  if constexpr (kModel == LensModel::brown_conrady) return brownConradyJacobian(d, x, y);
  if constexpr (kModel == LensModel::kannala_brandt) return kannalaBrandtJacobian(d, x, y);
  return {T(1), T(0), T(1)};
}

template <LensModel kModel>
using LensModelConstant = std::integral_constant<LensModel, kModel>;

/// Calls `use` with the model as a LensModelConstant and returns what it returns.
template <typename Use>
THERMOVOX_INLINE_LOOP auto withLensModel(LensModel model, const Use& use) {
  switch (model) {
    case LensModel::brown_conrady:
      return use(LensModelConstant<LensModel::brown_conrady>());
    case LensModel::kannala_brandt:
      return use(LensModelConstant<LensModel::kannala_brandt>());
    case LensModel::pinhole:
      break;
  }
  return use(LensModelConstant<LensModel::pinhole>());
}

template <typename T>
Vec2<T> distort(LensModel model, const T* d, const Vec2<T>& n) {
  return withLensModel(model, [&](auto lens) -> Vec2<T> {
    const Coordinates2<T> distorted = distortBy<lens.value>(d, n.x(), n.y());
    return {distorted.x, distorted.y};
  });
}

/// The one projection formula of the project: the mapper calls it with double, one point or many at a time,
/// the calibrator with ceres::Jet, so all always agree. `parameters` has kCameraParameters entries. Camera
/// frame: x right, y down, z forward, metres; the pixel (0, 0) is the CENTRE of the top-left one.
/// Precondition: z > 0. Without distortion it is equation 1 of the paper:
/// X = (u - cx) d / fx, Y = (v - cy) d / fy, Z = d.
template <LensModel kModel, typename T>
THERMOVOX_INLINE_LOOP Coordinates2<T> pixelFromCameraBy(const T* parameters, const T& x, const T& y,
                                                        const T& z) {
  const Coordinates2<T> distorted = distortBy<kModel, T>(parameters + kDistortion, x / z, y / z);
  return {parameters[kFx] * distorted.x + parameters[kCx], parameters[kFy] * distorted.y + parameters[kCy]};
}

template <typename T>
Vec2<T> pixelFromCamera(LensModel model, const T* parameters, const Vec3<T>& p_camera) {
  return withLensModel(model, [&](auto lens) -> Vec2<T> {
    const Coordinates2<T> pixel =
        pixelFromCameraBy<lens.value, T>(parameters, p_camera.x(), p_camera.y(), p_camera.z());
    return {pixel.x, pixel.y};
  });
}

}  // namespace thermovox
