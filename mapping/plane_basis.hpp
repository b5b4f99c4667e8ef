#pragma once

#include <Eigen/Geometry>

namespace thermovox {

/// Two unit vectors that span the plane across a unit normal: columns, right-handed with it.
[[nodiscard]] inline Eigen::Matrix<double, 3, 2> planeBasis(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = normal.unitOrthogonal();
  basis.col(1) = normal.cross(basis.col(0));
  return basis;
}

}  // namespace thermovox
