#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/station.hpp"
#include "mapping/hotspot_detection.hpp"
#include "mapping/hotspot_history.hpp"

namespace thermovox {

/// The hot spots of a station over its missions, and what they were found in.
struct StationHotspots {
  std::vector<MissionRecord> missions;  ///< those that the history is of, in the order of their flights
  std::vector<std::unique_ptr<SurfaceLayer>> layers;  ///< of these missions
  HotspotHistory history;
  std::vector<std::string> without_layer;  ///< names of missions whose own temperatures nobody has kept
};

/// Finds them mission by mission, with the errors that each declares. In a station of which no mission has
/// kept its own temperatures (of an older program) the sum of all stands for one mission, named by them all.
/// Throws DataError when the station, or the rig of a mission in it, cannot be read.
[[nodiscard]] StationHotspots stationHotspots(const Station& station, const HotspotCriteria& criteria);

}  // namespace thermovox
