#pragma once

#include <vector>

#include "apps/simulate/simulation.hpp"
#include "projection/laser/multi_beam.hpp"
#include "projection/laser/range_finder.hpp"

namespace thermovox::simulate {

/// What the laser would put out in one sweep. Every echo is cast from the true pose at its own time; noise is
/// along the ray. The draws are of the seed and the sweep alone.

/// Precondition: the simulation's laser is a beam.
[[nodiscard]] BeamReading sampleBeam(const Simulation& simulation, std::size_t sweep);
/// Ranges in metres, infinite beyond the laser's reach. Precondition: a scan.
[[nodiscard]] std::vector<float> sampleScan(const Simulation& simulation, std::size_t sweep);
/// Points in the laser's frame, column by column; echoes beyond the laser's reach are left out. A share of
/// outlier_share are weak echoes before the surface, under min_intensity. Precondition: a cloud.
[[nodiscard]] std::vector<CloudPoint> sampleCloud(const Simulation& simulation, std::size_t sweep);

}  // namespace thermovox::simulate
