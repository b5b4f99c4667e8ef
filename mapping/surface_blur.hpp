#pragma once

#include <Eigen/Core>

namespace thermovox {

/// How a camera smears the temperatures of a surface: over it, by a Gaussian with the covariance
/// variance I + oblique oblique^T, m^2.
struct SurfaceBlur {
  double variance = 0.0;  ///< across the view, m^2
  /// Along the surface the way the view goes, metres: what is seen at an angle is smeared further there.
  Eigen::Vector3d oblique = Eigen::Vector3d::Zero();
};

/// Of a camera whose optics, pixels and interpolation smear by `sigma` radians, that sees a place from `view`
/// (camera to place, metres) on a surface with the unit normal `normal` (sign arbitrary; zero: taken for one
/// that faces the camera). Seen at the angle a off the normal a length of the surface appears cos(a) times
/// shorter; beyond 78 degrees it is taken for 78.
[[nodiscard]] SurfaceBlur surfaceBlur(const Eigen::Vector3d& view, const Eigen::Vector3d& normal,
                                      double sigma);

}  // namespace thermovox
