#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "calibration/reprojection_residual.hpp"

namespace thermovox {

/// A ray that passes an edge of the board: between a return from the board and its neighbour from beyond.
struct EdgeCrossing {
  Eigen::Vector3d ray;  ///< unit vector, laser frame
  int axis = 0;         ///< of the board's frame across the edge: 0 is x, 1 is y
  double place = 0.0;   ///< of the edge on that axis, signed: half the plate's size, metres
  double sigma = 0.0;   ///< of the crossing on that axis, metres
};

/// All crossings of one side of the board in one capture. A scanner's lines that run along the edge pass it
/// all at one distance: `offset_sigma` (metres) is what their errors have in common.
struct EdgeSide {
  std::vector<EdgeCrossing> crossings;
  double offset_sigma = 0.0;
};

/// Where the rays meet the board's plane, against where the plate ends, in sigmas. The range of no return is
/// in it: beside an edge they are of mixtures. Whitened by the covariance diag(sigma^2) + offset_sigma^2 1
/// 1^T, times factor^2: of the residuals r in their own sigmas the part along a = 1 / sigma is shrunk.
/// Blocks: T_reference_board [7], T_reference_laser [7], edge bias [1]: what the width of the beam adds to
/// every edge, metres. Residual: one a crossing.
struct EdgeResidual {
  EdgeSide side;
  double factor = 1.0;

  template <typename T>
  bool operator()(const T* const* blocks, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, Eigen::Dynamic, 1>> r(residual,
                                                      static_cast<Eigen::Index>(side.crossings.size()));
    Eigen::VectorXd along(r.size());
    for (std::size_t i = 0; i < side.crossings.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (!compare(side.crossings[i], blocks[0], blocks[1], blocks[2], &r[row])) return false;
      along[row] = 1.0 / side.crossings[i].sigma;
    }
    const double shrunk = 1.0 / std::hypot(1.0, side.offset_sigma * along.norm());
    along.normalize();
    T common(0.0);
    for (Eigen::Index i = 0; i < r.size(); ++i) common += r[i] * along[i];
    for (Eigen::Index i = 0; i < r.size(); ++i) r[i] = (r[i] - common * ((1.0 - shrunk) * along[i])) / factor;
    return true;
  }

 private:
  template <typename T>
  static bool compare(const EdgeCrossing& edge, const T* T_reference_board, const T* T_reference_laser,
                      const T* edge_bias, T* residual) {
    const Eigen::Map<const Eigen::Quaternion<T>> board(T_reference_board), laser(T_reference_laser);
    const Eigen::Map<const Vec3<T>> t_board(T_reference_board + 4), t_laser(T_reference_laser + 4);
    const Vec3<T> origin = board.conjugate() * (t_laser - t_board);
    const Vec3<T> ray = board.conjugate() * (laser * edge.ray.cast<T>());
    if (!(ray.z() > T(0.05))) return false;
    const T reach = -origin.z() / ray.z();
    const T across = origin[edge.axis] + reach * ray[edge.axis];
    const T outwards = T(edge.place > 0.0 ? 1.0 : -1.0);
    *residual = (outwards * (across - T(edge.place)) - *edge_bias) / T(edge.sigma);
    return true;
  }
};

}  // namespace thermovox
