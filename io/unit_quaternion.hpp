#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <string>

#include "io/number_text.hpp"

namespace thermovox {

/// How far the norm of a written quaternion may be off one: rounding to a few decimals stays far below it,
/// swapped or missing components do not.
inline constexpr double kQuaternionTolerance = 0.01;

/// The normalised quaternion; nullopt when its norm is off one by more than kQuaternionTolerance or not
/// finite.
[[nodiscard]] inline std::optional<Eigen::Quaterniond> unitQuaternion(double x, double y, double z,
                                                                      double w) {
  const Eigen::Quaterniond quaternion(w, x, y, z);
  const double norm = quaternion.norm();
  if (!(std::abs(norm - 1.0) <= kQuaternionTolerance)) return std::nullopt;
  // Normalising a quaternion that is one already could change its last bits, so it is left as it was written.
  return std::abs(norm - 1.0) < 1e-15 ? quaternion : quaternion.normalized();
}

/// What to say of a quaternion that unitQuaternion refuses.
[[nodiscard]] inline std::string quaternionFault(double x, double y, double z, double w) {
  return "the quaternion x y z w = " + exactText(x) + " " + exactText(y) + " " + exactText(z) + " " +
         exactText(w) + " has norm " + exactText(Eigen::Quaterniond(w, x, y, z).norm()) +
         ", expected 1 within 1 %";
}

}  // namespace thermovox
