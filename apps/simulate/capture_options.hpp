#pragma once

#include <cstdint>
#include <numbers>

#include "projection/rig.hpp"

namespace thermovox::simulate {

/// How far the rig that lies beside the captures is from the true one: what calibration starts from.
/// Intrinsics and the place of the visible camera are those of a data sheet and a drawing: some per cent, no
/// distortion, cameras side by side.
struct GuessError {
  double rotation_sigma = 1.5 * std::numbers::pi / 180.0;  ///< of the laser on the body, radians an axis
  double translation_sigma = 0.02;                         ///< likewise, metres an axis
};

/// Captures of a heated chessboard to calibrate a rig by, and how well they are made.
struct CaptureOptions {
  LaserKind laser = LaserKind::cloud;
  int captures = 20;
  /// Beam only: further captures whose beam grazes an edge of the board, all four sides in turn.
  int edge_captures = 0;
  int spoiled = 0;         ///< of `captures`, how many whose board moved between the images and the laser
  std::uint64_t seed = 1;  ///< of rig, room, boards and noise

  double range_sigma = 0.008;       ///< along the ray, one sigma, metres
  double capture_bias_sigma = 0.0;  ///< common to all ranges of a capture, one sigma, metres
  double netd = 0.05;               ///< noise of a thermal pixel, one sigma, C
  double blur_px = 0.6;             ///< of the thermal camera: optics and pixel together, one sigma, px
  double contrast = 8.0;            ///< warm squares over cold ones, where the board is hottest, C
  double beam_spot_sigma = 0.003;   ///< how a beam's spot wanders on the board, one sigma an axis, metres
  GuessError guess;

  unsigned threads = 2;  ///< the result does not depend on it

  [[nodiscard]] int count() const { return captures + edge_captures; }

  /// Throws ConfigError naming the option, its value and what was expected.
  void validate() const;
};

}  // namespace thermovox::simulate
