#pragma once

#include "projection/rig.hpp"

namespace thermovox {

/// The words that rigs, reports and options use for a kind of laser, for a lens model and for a
/// model of the air.
[[nodiscard]] const char* nameOf(LaserKind kind);
[[nodiscard]] const char* nameOf(LensModel model);
[[nodiscard]] const char* nameOf(AtmosphereModel model);

}  // namespace thermovox
