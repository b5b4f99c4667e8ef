#pragma once

#include "mapping/block.hpp"
#include "mapping/occupancy_model.hpp"
#include "projection/cpu_level.hpp"

namespace thermovox {

/// What a reading does to the log-odds of a cell, in quanta.
struct OccupancySteps {
  std::int8_t hit = 0;
  std::int8_t miss = 0;
  std::int8_t lowest = 0;  ///< the clamps
  std::int8_t highest = 0;
  /// What a cell counts as before a hit, at least.
  std::int8_t before_hit = -127;
};

/// Updates the cells of a block: `hit` ones by the hit, those `passed` and not hit by the miss; what was
/// unknown counts as 0 before. The same at every level.
void updateLogOdds(BlockLogOdds::Bytes& log_odds, const CellBits& passed, const CellBits& hit,
                   const OccupancySteps& steps, CpuLevel level = cpuLevel());

}  // namespace thermovox
