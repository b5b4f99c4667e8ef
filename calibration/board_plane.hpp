#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "projection/rig.hpp"

namespace thermovox {

/// What all ranges of one capture say of the plane they lie on, in four numbers.
///
/// A plane n . p = d in the laser's frame is q = n / d: a ray u (unit) meets it at the range 1 / (q . u).
/// With the rays' own best plane q0 and rho = 1 / (q0 . u) a range differs from another plane's, in sigmas,
/// by
///
///   (r + b - 1 / (q . u)) / sigma  ~  e + (rho^2 u . (q - q0) + b) / sigma,
///
/// to second order in what is a thousandth here. All rays together are |slope [q - q0; b] + offset|^2 plus
/// what no plane explains: the triangular factor of a QR decomposition. Noise is in the ranges only, so that
/// steep boards and near ones are weighted as they should be; distances from the plane are not.
struct PlaneMoments {
  Eigen::Vector3d inverse_plane = Eigen::Vector3d::Zero();  ///< q0, 1 / m; 0 along what the rays do not span
  Eigen::Matrix4d slope = Eigen::Matrix4d::Zero();          ///< of q (m) and the bias b (1 / m)
  Eigen::Vector4d offset = Eigen::Vector4d::Zero();
  int returns = 0;     ///< that are in it
  int outliers = 0;    ///< that are not: more than 3.5 sigmas off
  double sigma = 0.0;  ///< of one range, metres: as they scatter about the plane, and as the rig says
  /// By how much the variances are larger than by `sigma` alone: rays of one channel of a multi-beam laser
  /// err together. 1 where each errs by itself.
  double channel_effect = 1.0;
  /// Some of the rays (unit) that are in it, as far from each other as they get, and the ranges of the plane
  /// there (metres).
  std::vector<Eigen::Vector3d> corner_rays;
  std::vector<double> corner_ranges;
};

/// The plane of returns that are on the board, but for a few (metres, laser frame). `range_sigma` is the
/// rig's. None where they do not span what the kind of laser sees of a plane: nothing, a line, a plane.
[[nodiscard]] std::optional<PlaneMoments> planeMoments(const std::vector<Eigen::Vector3d>& returns_laser,
                                                       LaserKind kind, double range_sigma);

/// How many directions a laser's rays span: 1, 2 or 3.
[[nodiscard]] constexpr int dimensionsOf(LaserKind kind) {
  return kind == LaserKind::beam ? 1 : kind == LaserKind::scan ? 2 : 3;
}

}  // namespace thermovox
