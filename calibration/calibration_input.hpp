#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/board_capture.hpp"
#include "projection/calibration_board.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// A camera before it is calibrated.
struct CameraGuess {
  Intrinsics intrinsics;    ///< its lens model and size are taken, its numbers are where to begin
  Pose T_reference_camera;  ///< of the rig; the identity for the reference camera
  /// Whether its intrinsics are unknowns, or exact as they are.
  enum class Lens { estimate, keep };
  Lens lens = Lens::estimate;
};

/// A laser before it is calibrated.
struct LaserGuess {
  LaserKind kind = LaserKind::cloud;
  Pose T_reference_laser;         ///< of the rig; it need not be near
  double range_sigma = 0.02;      ///< metres
  double range_bias_sigma = 0.0;  ///< common to all ranges, metres
};

/// What a rig is calibrated from.
struct CalibrationInput {
  CalibrationBoard board;
  std::vector<CameraGuess> cameras;  ///< the reference camera first
  std::optional<LaserGuess> laser;   ///< none: the cameras alone
  std::vector<BoardCapture> captures;
};

/// A capture, or what one instrument saw in it, that does not count.
struct DroppedCapture {
  std::string capture;  ///< its name
  std::string reason;   ///< the end of a sentence about it
};

}  // namespace thermovox
