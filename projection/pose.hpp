#pragma once

#include <Eigen/Geometry>

namespace thermovox {

/// Rigid transform T_a_b: `p_a = T_a_b * p_b`. Translation in metres and a unit quaternion (x y z w).
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] Pose inverse() const {
    const Eigen::Quaterniond conjugate = rotation.conjugate();
    return {conjugate, -(conjugate * translation)};
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const { return rotation.toRotationMatrix(); }

  /// T_a_b * T_b_c = T_a_c; the quaternion is renormalised, so that long chains stay rotations.
  friend Pose operator*(const Pose& T_a_b, const Pose& T_b_c) {
    return {(T_a_b.rotation * T_b_c.rotation).normalized(), T_a_b * T_b_c.translation};
  }
  friend Eigen::Vector3d operator*(const Pose& T_a_b, const Eigen::Vector3d& p_b) {
    return T_a_b.rotation * p_b + T_a_b.translation;
  }
  /// The same rigid motion: q and -q are one rotation.
  friend bool operator==(const Pose& a, const Pose& b) {
    const bool same_rotation =
        a.rotation.coeffs() == b.rotation.coeffs() || a.rotation.coeffs() == -b.rotation.coeffs();
    return same_rotation && a.translation == b.translation;
  }
};

/// The one pose interpolation of the project: slerp of the rotation (the short way), linear in the
/// translation. fraction 0 gives a, 1 gives b.
[[nodiscard]] inline Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  return {a.rotation.slerp(fraction, b.rotation).normalized(),
          a.translation + fraction * (b.translation - a.translation)};
}

/// [v]x, the matrix of the cross product: `skew(v) * w = v x w`.
[[nodiscard]] inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Exp of so(3): the rotation by |w| radians about w.
[[nodiscard]] inline Eigen::Quaterniond expRotation(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-12) return Eigen::Quaterniond(1.0, w.x() / 2, w.y() / 2, w.z() / 2).normalized();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, w / angle));
}

/// The six-vector of a small motion: rotation x y z (radians), then translation x y z (metres).
using Vector6d = Eigen::Matrix<double, 6, 1>;
/// Covariance of such a motion, in the same order.
using Matrix6d = Eigen::Matrix<double, 6, 6>;

}  // namespace thermovox
