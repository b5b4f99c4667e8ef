#pragma once

#include <vector>

#include "apps/calibration_job.hpp"
#include "io/calibration_report.hpp"

namespace thermovox {

/// Every capture of the folder as a report tells of it. Its images are read again.
[[nodiscard]] std::vector<ReportedCapture> reportedCaptures(const CalibrationRun& run);

/// Whether nothing but the rig's first guess says where the laser is.
[[nodiscard]] bool laserByGuess(const CalibrationRun& run);

}  // namespace thermovox
