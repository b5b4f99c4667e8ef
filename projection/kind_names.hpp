#pragma once

#include "projection/rig.hpp"

namespace thermovox {

/// The words that rigs, reports and options use for a kind of laser and for a lens model.
[[nodiscard]] const char* nameOf(LaserKind kind);
[[nodiscard]] const char* nameOf(LensModel model);

}  // namespace thermovox
