#pragma once

#include "projection/radiometry.hpp"

namespace thermovox::test {

/// A FLIR SC660 as published with Thermimage, whose defaults these are.
inline RadiometricParameters sc660() {
  RadiometricParameters parameters;
  parameters.planck = {21106.77, 0.012545258, 1501.0, 1.0, -7340.0};
  return parameters;
}

}  // namespace thermovox::test
