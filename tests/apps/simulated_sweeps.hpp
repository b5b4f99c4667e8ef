#pragma once

#include "apps/simulate/laser_sampling.hpp"
#include "apps/simulate/simulated_sources.hpp"
#include "apps/simulate/simulation.hpp"

namespace thermovox::simulate {

inline constexpr LaserKind kKinds[] = {LaserKind::beam, LaserKind::scan, LaserKind::cloud};

inline SimulationOptions optionsOf(LaserKind laser, double duration = 1.0) {
  SimulationOptions options;
  options.laser = laser;
  options.seed = 11;
  options.duration = duration;
  return options;
}

}  // namespace thermovox::simulate
