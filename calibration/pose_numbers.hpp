#pragma once

#include <array>

#include "projection/pose.hpp"

namespace thermovox {

/// A pose as Ceres varies it: [qx qy qz qw tx ty tz].
using PoseNumbers = std::array<double, 7>;

[[nodiscard]] inline PoseNumbers numbersOf(const Pose& pose) {
  const auto& q = pose.rotation.coeffs();
  const auto& t = pose.translation;
  return {q[0], q[1], q[2], q[3], t[0], t[1], t[2]};
}

[[nodiscard]] inline Pose poseOf(const PoseNumbers& n) {
  return {Eigen::Quaterniond(n[3], n[0], n[1], n[2]).normalized(), {n[4], n[5], n[6]}};
}

}  // namespace thermovox
