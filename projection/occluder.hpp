#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

#include "projection/cpu_level.hpp"

namespace thermovox {

/// A look from the camera at a point.
struct Sight {
  Eigen::Vector3d camera_world;  ///< the camera's centre, metres
  Eigen::Vector3d p_world;       ///< the point looked at, metres
  Eigen::Vector2d pixel;         ///< where it projects
  double depth = 0.0;            ///< its z in the camera frame, metres
};

/// Many looks from one place, as columns of equal length.
struct Sights {
  Eigen::Vector3d camera_world;
  std::span<const double> x, y, z;  ///< the points, world
  std::span<const double> u, v;     ///< where they project
  std::span<const double> depth;
  CpuLevel level = CpuLevel::baseline;  ///< what loops over them may use

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Sight operator[](std::size_t i) const {
    return {camera_world, {x[i], y[i], z[i]}, {u[i], v[i]}, depth[i]};
  }
};

/// Does anything stand between the camera and the point? Implemented by the depths that the laser measured
/// around a frame (DepthSectors) and by whole maps.
class Occluder {
 public:
  virtual ~Occluder() = default;
  [[nodiscard]] virtual bool hides(const Sight& sight) const = 0;

  /// The same for many: writes 1 for each look that is hidden and 0 for the others.
  virtual void hide(const Sights& sights, std::span<std::uint8_t> hidden) const {
    for (std::size_t i = 0; i < sights.size(); ++i) hidden[i] = hides(sights[i]) ? 1 : 0;
  }
};

/// Nothing hides anything: for scenes of one surface, and as the oracle's baseline.
class NoOccluder final : public Occluder {
 public:
  [[nodiscard]] bool hides(const Sight& /*sight*/) const override { return false; }
};

}  // namespace thermovox
