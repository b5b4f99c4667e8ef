#pragma once

#include <filesystem>

#include "apps/simulate/simulation.hpp"
#include "apps/simulate/simulation_options.hpp"

namespace thermovox::simulate {

/// Where the truth of the mission `out` lies: OUT.truth.json beside it.
[[nodiscard]] std::filesystem::path truthPath(const std::filesystem::path& out);

/// Flies the mission and writes the folder `out` and the truth beside it. Same options and name, same bytes,
/// whatever the number of threads. Both appear whole, or not at all. Throws ConfigError for an option that
/// cannot be used and DataError where out or its truth exists already or cannot be written.
void simulateMission(const SimulationOptions& options, const std::filesystem::path& out);

}  // namespace thermovox::simulate
