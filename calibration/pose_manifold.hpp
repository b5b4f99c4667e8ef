#pragma once

#include <ceres/autodiff_manifold.h>
#include <ceres/manifold.h>

#include <Eigen/Geometry>

namespace thermovox {

// Rigid transforms as Ceres varies them: seven numbers, the quaternion [x y z w] and the translation. The
// tangent's rotation is a full angle in radians, as covariances are published; that of Ceres' own
// EigenQuaternionManifold is half of it.

/// Exp of so(3) for types of derivatives; at 0 by its series, so that the derivative is known there.
template <typename T>
Eigen::Quaternion<T> expRotationOf(const Eigen::Matrix<T, 3, 1>& w) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T square = w.squaredNorm();
  if (!(square > T(1e-16))) {
    return Eigen::Quaternion<T>(T(1) - square / T(8), w.x() * T(0.5), w.y() * T(0.5), w.z() * T(0.5));
  }
  const T angle = sqrt(square);
  const Eigen::Matrix<T, 3, 1> v = w * (sin(angle * T(0.5)) / angle);
  return Eigen::Quaternion<T>(cos(angle * T(0.5)), v.x(), v.y(), v.z());
}

template <typename T>
Eigen::Matrix<T, 3, 1> logRotationOf(const Eigen::Quaternion<T>& q) {
  using std::atan2;
  using std::sqrt;
  const T sign = q.w() < T(0) ? T(-1) : T(1);
  const T square = q.vec().squaredNorm();
  if (!(square > T(1e-16))) return q.vec() * (T(2) * sign);
  const T norm = sqrt(square);
  return q.vec() * (sign * T(2) * atan2(norm, sign * q.w()) / norm);
}

/// A pose T_a_b, varied in a: R' = Exp(w) R, t' = t + v, with the tangent (w, v).
struct LeftPosePlus {
  template <typename T>
  bool Plus(const T* x, const T* delta, T* x_plus_delta) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(x);
    const Eigen::Map<const Eigen::Matrix<T, 6, 1>> d(delta);
    Eigen::Map<Eigen::Quaternion<T>> turned(x_plus_delta);
    turned = expRotationOf<T>(d.template head<3>()) * q;
    for (int i = 0; i < 3; ++i) x_plus_delta[4 + i] = x[4 + i] + d[3 + i];
    return true;
  }
  template <typename T>
  bool Minus(const T* y, const T* x, T* y_minus_x) const {
    const Eigen::Map<const Eigen::Quaternion<T>> to(y), from(x);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> d(y_minus_x);
    d.template head<3>() = logRotationOf<T>(to * from.conjugate());
    for (int i = 0; i < 3; ++i) d[3 + i] = y[4 + i] - x[4 + i];
    return true;
  }
};

/// A laser's pose T_a_laser, its rotation varied in the laser: R' = R Exp(w), t' = t + v. kTurns is 3, or 2
/// for a beam, whose roll about its own axis x no measurement can tell: it stays as it is, and the tangent is
/// (w_y, w_z, v).
template <int kTurns>
struct LaserPosePlus {
  template <typename T>
  bool Plus(const T* x, const T* delta, T* x_plus_delta) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(x);
    Eigen::Matrix<T, 3, 1> w = Eigen::Matrix<T, 3, 1>::Zero();
    for (int i = 0; i < kTurns; ++i) w[3 - kTurns + i] = delta[i];
    Eigen::Map<Eigen::Quaternion<T>> turned(x_plus_delta);
    turned = q * expRotationOf<T>(w);
    for (int i = 0; i < 3; ++i) x_plus_delta[4 + i] = x[4 + i] + delta[kTurns + i];
    return true;
  }
  template <typename T>
  bool Minus(const T* y, const T* x, T* y_minus_x) const {
    const Eigen::Map<const Eigen::Quaternion<T>> to(y), from(x);
    const Eigen::Matrix<T, 3, 1> w = logRotationOf<T>(from.conjugate() * to);
    for (int i = 0; i < kTurns; ++i) y_minus_x[i] = w[3 - kTurns + i];
    for (int i = 0; i < 3; ++i) y_minus_x[kTurns + i] = y[4 + i] - x[4 + i];
    return true;
  }
};

using PoseManifold = ceres::AutoDiffManifold<LeftPosePlus, 7, 6>;
using LaserManifold = ceres::AutoDiffManifold<LaserPosePlus<3>, 7, 6>;
using BeamManifold = ceres::AutoDiffManifold<LaserPosePlus<2>, 7, 5>;

}  // namespace thermovox
