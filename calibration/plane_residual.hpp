#pragma once

#include "calibration/board_plane.hpp"
#include "calibration/reprojection_residual.hpp"

namespace thermovox {

/// The board's plane as the laser should see it, as q with range = 1 / (q . u) for the ray u: the plane
/// n . p = d in the laser's frame has q = n / d.
template <typename T>
Vec3<T> inversePlane(const T* T_reference_board, const T* T_reference_laser) {
  const Eigen::Map<const Eigen::Quaternion<T>> board(T_reference_board), laser(T_reference_laser);
  const Eigen::Map<const Vec3<T>> t_board(T_reference_board + 4), t_laser(T_reference_laser + 4);
  const Vec3<T> normal = board * Vec3<T>::UnitZ().eval();
  return (laser.conjugate() * normal) / normal.dot(t_board - t_laser);
}

/// All ranges of a capture against the board's plane, in sigmas: see PlaneMoments.
/// Blocks: T_reference_board [7], T_reference_laser [7], range bias of the capture [1], metres. Residual: 4.
struct PlaneResidual {
  PlaneMoments moments;

  template <typename T>
  bool operator()(const T* T_reference_board, const T* T_reference_laser, const T* range_bias,
                  T* residual) const {
    Eigen::Matrix<T, 4, 1> change;
    change << inversePlane<T>(T_reference_board, T_reference_laser) - moments.inverse_plane.cast<T>(),
        *range_bias;
    if (!(change.squaredNorm() < T(1e12))) return false;
    Eigen::Map<Eigen::Matrix<T, 4, 1>> r(residual);
    r = moments.slope.cast<T>() * change + moments.offset.cast<T>();
    return true;
  }
};

}  // namespace thermovox
