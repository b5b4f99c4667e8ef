#pragma once

#include "projection/calibration_board.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// The words that rigs, captures, reports and options use for a kind of laser, for a lens model, for a model
/// of the air and for a calibration board's pattern.
[[nodiscard]] const char* nameOf(LaserKind kind);
[[nodiscard]] const char* nameOf(LensModel model);
[[nodiscard]] const char* nameOf(AtmosphereModel model);
[[nodiscard]] const char* nameOf(CalibrationBoard::Pattern pattern);

}  // namespace thermovox
