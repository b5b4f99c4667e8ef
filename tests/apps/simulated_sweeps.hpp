#pragma once

#include <vector>

#include "apps/simulate/laser_sampling.hpp"
#include "apps/simulate/simulation.hpp"
#include "projection/laser/multi_beam.hpp"
#include "projection/laser/planar_scanner.hpp"
#include "projection/laser/range_finder.hpp"

namespace thermovox::simulate {

inline constexpr LaserKind kKinds[] = {LaserKind::beam, LaserKind::scan, LaserKind::cloud};

inline SimulationOptions optionsOf(LaserKind laser, double duration = 1.0) {
  SimulationOptions options;
  options.laser = laser;
  options.seed = 11;
  options.duration = duration;
  return options;
}

/// One sweep as a reader of the files gets it.
inline Reading readSweep(const Simulation& simulation, std::size_t sweep) {
  const Laser& laser = simulation.rig().lasers.front();
  switch (simulation.options().laser) {
    case LaserKind::beam:
      return readingFromBeam(sampleBeam(simulation, sweep), laser);
    case LaserKind::scan:
      return readingFromScan(simulation.sweepStamp(sweep), sampleScan(simulation, sweep), laser);
    case LaserKind::cloud:
      break;
  }
  return readingFromCloud(simulation.sweepStamp(sweep), sampleCloud(simulation, sweep), laser);
}

}  // namespace thermovox::simulate
