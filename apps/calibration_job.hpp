#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "calibration/rig_calibration.hpp"
#include "io/capture_folder.hpp"

namespace thermovox {

enum class CalibrationTask {
  camera,  ///< one camera's lens
  stereo,  ///< both lenses, and how the cameras stand to each other
  laser,   ///< the laser's pose, with all cameras that help
};

enum class CalibrationCamera { thermal, visible };

struct CalibrationJob {
  CalibrationTask task = CalibrationTask::laser;
  CalibrationCamera camera = CalibrationCamera::thermal;
  CameraGuess::Lens lens = CameraGuess::Lens::estimate;
  int laser = 0;    ///< which of the rig's
  int threads = 0;  ///< 0: one for each processor
  std::function<void(const std::string& stage, double done)> progress;
};

/// A calibration and what it was made from.
struct CalibrationRun {
  CaptureFolder folder;
  std::vector<CalibrationCamera> cameras;  ///< that take part, the reference camera first
  CalibrationInput input;
  RigCalibration result;
  std::vector<std::string> without_board;  ///< images in which no board was found, as their list names them
  std::string refused;                     ///< why there is no result at all; empty where there is one
};

/// Finds the boards in the folder's images and reads its laser's files; there is no result yet. Throws
/// ConfigError or DataError naming the file for what is damaged or missing.
[[nodiscard]] CalibrationRun readCalibration(const std::filesystem::path& captures,
                                             const CalibrationJob& job);

/// Calibrates by what was read. Throws UnobservableError where the cameras cannot be determined, and leaves
/// why in `refused`; a laser that cannot be is told by the result.
void calibrate(CalibrationRun& run, const CalibrationJob& job);

/// The folder's rig with what was calibrated in it, and its covariances.
[[nodiscard]] Rig calibratedRig(const CalibrationRun& run, const CalibrationJob& job);

}  // namespace thermovox
