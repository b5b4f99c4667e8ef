#pragma once

#include <string>
#include <vector>

#include "calibration/board_capture.hpp"
#include "calibration/calibration_input.hpp"
#include "calibration/rig_bundle.hpp"

namespace thermovox {

/// Cameras and boards to begin the bundle with.
struct CameraStart {
  RigEstimate estimate;  ///< without the laser
  /// As given, with the corners of each view in the order of one and the same side of the board, and without
  /// views that no board explains.
  std::vector<BoardCapture> captures;
  std::vector<DroppedCapture> dropped;  ///< what is no longer in `captures`, or not with all its views
};

/// The corners of a view as the bundle takes them.
[[nodiscard]] std::vector<CornerObservation> cornersOf(const BoardView& view, int camera);

/// Finds where the boards were and what the cameras are, one camera after the other, then how they stand to
/// each other. Intrinsics are fitted from the input's and, where the lens has a plane's closed form (Zhang
/// 2000), also from nothing; the better fit counts. Which side of a symmetric board a view begins with is
/// what most captures agree on; where they cannot tell, what the input's poses say. Throws UnobservableError
/// where no capture has a view of the reference camera.
[[nodiscard]] CameraStart startCameras(const CalibrationInput& input);

}  // namespace thermovox
