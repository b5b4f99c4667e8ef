#pragma once

#include "apps/simulate/capture_options.hpp"
#include "projection/rig.hpp"

namespace thermovox::simulate {

/// The rig as it is: a thermal camera of the FLIR Duo R kind, 160 x 120, a visible one, 1920 x 1080, 14 mm
/// beside it, both with distortion, and the asked laser; drawn by the seed around what such a rig is.
[[nodiscard]] Rig drawTrueRig(const CaptureOptions& options);

/// The rig as it is known before calibration: the laser's place wrong by the options' GuessError, the thermal
/// camera's place exact (everything is told from there), the rest by data sheet and drawing.
[[nodiscard]] Rig drawGuessedRig(const CaptureOptions& options, const Rig& true_rig);

/// Readings of one sweep of the scanner.
inline constexpr int kCaptureScanReadings = 1081;

}  // namespace thermovox::simulate
