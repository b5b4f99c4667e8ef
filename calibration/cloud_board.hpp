#pragma once

#include <Eigen/Core>
#include <vector>

namespace thermovox {

/// A plate as it is sought: its two sides, metres, and how many times as large it may be: a board's plate is
/// larger than its pattern, nobody knows by how much.
struct SoughtPlate {
  Eigen::Vector2d sides;
  double most = 1.0;
};

/// Flat pieces of a cloud that a plate may be; see boardCandidates(). Spheres as large as the plate are laid
/// about points all over the cloud; where most of one lies on a plane, its points there have to fill a
/// rectangle of the plate's size.
[[nodiscard]] std::vector<std::vector<Eigen::Vector3d>> boardsInCloud(
    const std::vector<Eigen::Vector3d>& returns_laser, const SoughtPlate& plate);

}  // namespace thermovox
