#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace thermovox {

/// The mean of some returns of a surface: those of a cell.
struct HeightPoint {
  Eigen::Vector3d p_world;  ///< metres
  double returns = 1.0;     ///< how many; more than 0
};

/// How far a surface lies off a plane, at one place.
struct SurfaceHeight {
  double height = 0.0;                               ///< along the plane's normal, metres
  double sigma = 0.0;                                ///< of it, from the points' scatter
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface there, unit, to the plane's side
  double curvature = 0.0;                            ///< the larger one, 1/m; 0 where noise may have made it
};

/// Height of the surface through `points` over `origin` (world, metres) along the unit normal: the constant
/// of a quadric z = a + b u + c v + d u^2 + e u v + f v^2 by least squares, so that a curved surface is not
/// taken for a flat one. Points of one column, `edge` metres wide, are first made one, and every return
/// counts the same: the noise of the ranges puts some returns of a surface near a border of cells beyond it,
/// and these few must not stand for as much as the many before it. With fewer than twelve columns their mean;
/// none without points.
[[nodiscard]] std::optional<SurfaceHeight> surfaceHeight(std::span<const HeightPoint> points,
                                                         const Eigen::Vector3d& origin,
                                                         const Eigen::Vector3d& normal, double edge);

}  // namespace thermovox
