#pragma once

#include <filesystem>

#include "apps/calibration_job.hpp"
#include "io/atomic_file.hpp"

namespace thermovox {

/// Writes what a calibration found and how well, with every capture's pictures (they are read again), as one
/// HTML file; also of one that cannot be determined. `rig` is calibratedRig(). Throws DataError naming the
/// file.
void writeCalibrationReport(const CalibrationRun& run, const CalibrationJob& job, const Rig& rig,
                            const std::filesystem::path& file, Existing existing);

}  // namespace thermovox
