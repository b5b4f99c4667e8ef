#pragma once

#include <optional>
#include <string>

#include "projection/rig.hpp"
#include "projection/trajectory.hpp"

namespace thermovox {

/// What one flight or drive is, apart from its streams of readings and frames: who measured, where the body
/// was, and what is known of the errors that all its measurements share.
struct Mission {
  std::string name;
  Rig rig;
  Trajectory trajectory;
  double pose_rotation_sigma = 0.0;     ///< one sigma an axis, radians, common to the whole mission
  double pose_translation_sigma = 0.0;  ///< one sigma an axis, metres, common to the whole mission
  Duration camera_time_offset = Duration::zero();  ///< a frame stamped s was taken at s + this
  std::optional<double> ambient;                   ///< of the air, Celsius
};

}  // namespace thermovox
