#pragma once

#include <cstdint>
#include <optional>

#include "apps/simulate/hall.hpp"
#include "projection/camera_model.hpp"
#include "projection/pose.hpp"
#include "projection/rig.hpp"

namespace thermovox::simulate {

/// Errors that a mission's own files do not know of. They are drawn once a mission from the covariances given
/// here, which the rig and the mission then declare. All zero: the files are exact but for the noise of the
/// sensors.
struct DeclaredErrors {
  /// Of T_body_laser: the true R = Exp(w) R_written, t = t_written + v; w (radians), v (metres), body's axes.
  Matrix6d covariance_body_laser = Matrix6d::Zero();
  /// Radians an axis; the true R = Exp(w) R_written at every moment, w in the world's axes.
  double pose_rotation_sigma = 0.0;
  double pose_translation_sigma = 0.0;  ///< metres an axis, world
  /// Common to all temperatures, C: such a bias drifts over minutes, not from frame to frame.
  double camera_bias_sigma = 0.0;
  double range_bias_sigma = 0.0;  ///< common to all ranges, metres
};

/// What the thermal camera stores. tiff: temperatures, as if there were no air. rjpeg: radiometric JPEGs of
/// FLIR's kind, whose counts are of what is left of the radiation behind the air.
enum class FrameFormat { tiff, rjpeg };

/// How the body turns while it flies.
enum class FlightStyle {
  facing_rows,  ///< looks across the aisle and nods: the plane or the beam of a laser sweeps the rows
  along_aisle,  ///< looks ahead and swings from row to row
};

/// What to fly, with what, how well.
struct SimulationOptions {
  LaserKind laser = LaserKind::cloud;
  std::uint64_t seed = 1;                  ///< of hall, flight and noise
  std::optional<std::uint64_t> hall_seed;  ///< of the hall alone, to fly the same hall again; default `seed`
  HallChanges changes;                     ///< of the hall, since it was built
  double duration = 6.0;                   ///< seconds of measuring
  std::optional<FlightStyle> flight;       ///< default: along the aisle with a cloud, else facing the rows

  LensModel lens = LensModel::brown_conrady;
  double netd = 0.05;       ///< noise of a pixel, one sigma, C
  double blur_px = 0.6;     ///< optics and pixel together, one sigma, px
  int supersampling = 3;    ///< rays a pixel and axis
  double frame_rate = 5.0;  ///< thermal frames a second
  FrameFormat frames = FrameFormat::tiff;
  double air = 20.0;                         ///< temperature of the air, C (rjpeg)
  double humidity = 0.5;                     ///< of the air, relative, 0 to 1 (rjpeg)
  double emissivity = 1.0;                   ///< of all surfaces, 0.05 to 1 (rjpeg)
  std::optional<double> reflected;           ///< what they mirror, C (rjpeg); default the air's temperature
  double window_transmission = 1.0;          ///< of a window before the lens, 0.05 to 1; 1: none (rjpeg)
  std::optional<double> window_temperature;  ///< C (rjpeg); default the air's

  /// Whether a visible camera flies along.
  enum class VisibleCamera { absent, present };
  VisibleCamera visible = VisibleCamera::absent;  ///< takes its pictures together with the thermal frames

  double range_sigma = 0.01;    ///< along the ray, one sigma, metres
  double outlier_share = 0.01;  ///< of a cloud's points: weak echoes off the surface, 0..1
  double pose_rate = 100.0;     ///< poses a second
  double beam_rate = 100.0;     ///< readings a second
  double scan_rate = 40.0;      ///< sweeps a second
  double cloud_rate = 10.0;     ///< turns a second

  DeclaredErrors errors;
  unsigned threads = 2;  ///< the result does not depend on it

  /// Throws ConfigError naming the option, its value and what was expected.
  void validate() const;
};

}  // namespace thermovox::simulate
