#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace thermovox {

/// Sums over points, from which the plane through them follows.
struct PointSums {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< of the points, metres, from any place near them
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< of their products
  std::size_t count = 0;

  void add(const Eigen::Vector3d& p) {
    first += p;
    second += p * p.transpose();
    ++count;
  }
};

/// The plane of least squares through points.
struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, sign arbitrary; zero: they are no plane
  double width2 = 0.0;  ///< variance of the points along the plane's shorter axis, m^2
};

/// Thickness of a plane against its shorter width; and of what faces a side at all, as a pipe seen from one.
inline constexpr double kPlaneThickness = 0.35, kBulgeThickness = 0.7;

/// Points make a plane where it is not thicker than this. Precondition: count > 0.
[[nodiscard]] LocalPlane localPlane(const PointSums& sums, double thickness = kPlaneThickness);

}  // namespace thermovox
