#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace thermovox {

/// The surface about a point of a cloud.
struct LocalSurface {
  /// Normal of the plane through the neighbours (the direction of their least spread), unit, sign arbitrary;
  /// zero where there are fewer than five.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  int neighbours = 0;  ///< points within the radius, itself included
};

/// Of each point, from its neighbours within `radius` metres. A point that is not finite has none.
[[nodiscard]] std::vector<LocalSurface> localSurfaces(std::span<const Eigen::Vector3f> points, double radius);

}  // namespace thermovox
