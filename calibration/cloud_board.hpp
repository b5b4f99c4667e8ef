#pragma once

#include <Eigen/Core>
#include <vector>

namespace thermovox {

/// Flat pieces of a cloud that a plate (its two sides, metres) may be; see boardCandidates(). Spheres as large
/// as the plate are laid about points all over the cloud; where most of one lies on a plane, its points there
/// have to fill a rectangle of the plate's size.
[[nodiscard]] std::vector<std::vector<Eigen::Vector3d>> boardsInCloud(
    const std::vector<Eigen::Vector3d>& returns_laser, const Eigen::Vector2d& plate);

}  // namespace thermovox
