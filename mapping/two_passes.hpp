#pragma once

#include <vector>

#include "mapping/mission_mapper.hpp"

namespace thermovox {

/// A mission's recordings from their start, once for each pass, with who listens to it.
struct TwoPasses {
  MissionStreams geometry;  ///< whose frames are not read
  MissionStreams look;
  MissionListeners geometry_listeners;
  MissionListeners look_listeners;
};

/// Maps a mission in two passes into the map, which is to be empty: its geometry first; then, as options.pass
/// says (colours or paint), its temperatures, tested against `known` and its own geometry together, all of
/// which must outlive the call. Sets options.scene itself. Returns the account of the second pass. Throws
/// ConfigError when options.pass is neither, or when the maps' options differ, and what mapMission throws.
[[nodiscard]] MissionReport mapMissionTwice(const TwoPasses& passes, ThermalMap& map,
                                            std::vector<const ThermalMap*> known,
                                            MissionMapper::Options options);

}  // namespace thermovox
