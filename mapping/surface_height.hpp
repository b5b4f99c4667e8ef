#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace thermovox {

/// How far a surface lies off a plane, at one place.
struct SurfaceHeight {
  double height = 0.0;  ///< along the plane's normal, metres
  double sigma = 0.0;   ///< of it, from the points' scatter
};

/// Height of the surface through `points` (world, metres) over `origin` along the unit normal: the constant
/// of a quadric z = a + b u + c v + d u^2 + e u v + f v^2 by least squares, so that a curved surface is not
/// taken for a flat one. With fewer than twelve points the mean; none without points.
[[nodiscard]] std::optional<SurfaceHeight> surfaceHeight(std::span<const Eigen::Vector3d> points,
                                                         const Eigen::Vector3d& origin,
                                                         const Eigen::Vector3d& normal);

}  // namespace thermovox
