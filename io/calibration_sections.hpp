#pragma once

#include <string>

#include "io/calibration_report.hpp"

namespace thermovox {

// The sections of a calibration's report; each gives HTML.

[[nodiscard]] std::string calibrationCover(const CalibrationReport& report);
[[nodiscard]] std::string mountingSection(const CalibrationReport& report);
[[nodiscard]] std::string cameraSection(const CalibrationReport& report, std::size_t camera);
[[nodiscard]] std::string boardSection(const CalibrationReport& report);
/// The table of all captures, then each with its pictures.
[[nodiscard]] std::string captureSection(const CalibrationReport& report);
[[nodiscard]] std::string calibrationMethods(const CalibrationReport& report);

}  // namespace thermovox
