#pragma once

#include <Eigen/Core>

namespace thermovox {

/// A look from the camera at a point.
struct Sight {
  Eigen::Vector3d camera_world;  ///< the camera's centre, metres
  Eigen::Vector3d p_world;       ///< the point looked at, metres
  Eigen::Vector2d pixel;         ///< where it projects
  double depth = 0.0;            ///< its z in the camera frame, metres
};

/// Does anything stand between the camera and the point? Implemented by the depths that the laser measured
/// around a frame (DepthSectors) and by whole maps.
class Occluder {
 public:
  virtual ~Occluder() = default;
  [[nodiscard]] virtual bool hides(const Sight& sight) const = 0;
};

/// Nothing hides anything: for scenes of one surface, and as the oracle's baseline.
class NoOccluder final : public Occluder {
 public:
  [[nodiscard]] bool hides(const Sight& /*sight*/) const override { return false; }
};

}  // namespace thermovox
