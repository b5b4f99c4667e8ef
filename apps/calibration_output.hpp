#pragma once

#include <string>

#include "apps/calibration_job.hpp"

namespace thermovox {

/// One JSON object of a calibration, with what maps and scripts need of it. `rig` is calibratedRig().
[[nodiscard]] std::string calibrationJson(const CalibrationRun& run, const CalibrationJob& job,
                                          const Rig& rig);

/// The same for people.
[[nodiscard]] std::string calibrationTable(const CalibrationRun& run, const CalibrationJob& job,
                                           const Rig& rig);

/// Why the captures cannot determine what was asked for; empty where they can.
[[nodiscard]] std::string unobservableReason(const CalibrationRun& run, const CalibrationJob& job);

}  // namespace thermovox
