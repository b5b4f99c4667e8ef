#pragma once

#include <vector>

#include "apps/map_job.hpp"
#include "io/mission_folder.hpp"
#include "io/points_record.hpp"
#include "mapping/mission_report.hpp"
#include "mapping/thermal_map.hpp"

namespace thermovox {

/// Without a listener to warnings.
[[nodiscard]] MissionOptions missionOptions(const MapJob& job);

/// Maps one mission into an empty map, in as many passes as asked for, and shows how far it is; `known` is
/// the geometry besides the mission's own, `record` may be null. Throws DataError when colours were to be
/// expected and there is none.
[[nodiscard]] MissionReport mapOne(OpenedMission& opened, const MapJob& job,
                                   std::vector<const ThermalMap*> known, ThermalMap& map,
                                   PointsRecord* record);

}  // namespace thermovox
