#include "io/station_hotspots.hpp"

#include <algorithm>
#include <utility>

#include "io/rig_file.hpp"
#include "mapping/best_frame.hpp"
#include "mapping/intrinsics_error.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

Rig rigOf(const MissionRecord& mission, const Station& station) {
  if (mission.rig.empty()) return {};
  return parseRig(mission.rig, station.path().string() + ": the rig of mission '" + mission.name + "'");
}

/// Hot spots of one mission with all that it declares of its errors.
std::vector<Hotspot> hotspotsOf(const SurfaceLayer& layer, const MissionRecord& mission, const Rig& rig,
                                const CameraSight& camera, const HotspotCriteria& criteria) {
  std::vector<Hotspot> spots = findHotspots(layer, criteria, camera);
  for (const SharedMotion& motion : mission.shared_motions) {
    if (motion.laser < rig.lasers.size()) continue;
    throw DataError("the mission '" + mission.name + "' has returns of laser " +
                    std::to_string(motion.laser) + ", expected less than the " +
                    std::to_string(rig.lasers.size()) + " of its rig");
  }
  for (Hotspot& spot : spots) {
    // Cells keep their first temperature's time to 2.1 s, rounded down.
    if (mission.first) spot.first_seen = std::max(spot.first_seen, *mission.first);
    spot.position.common = sharedCovariance(spot.position.p_world, spot.normal, mission.shared_motions, rig,
                                            mission.pose_sigmas);
    if (!rig.thermal_camera) continue;
    findBestFrame(spot, mission.frame_poses, *rig.thermal_camera, layer.resolution());
    spot.position.common += intrinsicsCovariance(spot, mission.frame_poses, *rig.thermal_camera);
  }
  return spots;
}

void add(StationHotspots& result, const Station& station, MissionRecord mission, const ThermalMap& map,
         const HotspotCriteria& criteria) {
  const SurfaceLayer& layer = *result.layers.emplace_back(std::make_unique<SurfaceLayer>(map));
  const Rig rig = rigOf(mission, station);
  CameraSight camera = rig.thermal_camera ? sightOf(*rig.thermal_camera, mission.frame_poses) : CameraSight{};
  std::vector<Hotspot> spots = hotspotsOf(layer, mission, rig, camera, criteria);
  result.history.add({mission.name, &layer, std::move(spots), std::move(camera)});
  result.missions.push_back(std::move(mission));
}

/// What an older program has left: all missions as one.
MissionRecord allInOne(const std::vector<MissionRecord>& missions) {
  MissionRecord all = missions.front();
  for (std::size_t i = 1; i < missions.size(); ++i) {
    all.name += ", " + missions[i].name;
    if (missions[i].last) all.last = std::max(all.last.value_or(*missions[i].last), *missions[i].last);
  }
  all.shared_motions.clear();
  return all;
}

}  // namespace

StationHotspots stationHotspots(const Station& station, const HotspotCriteria& criteria) {
  StationHotspots result;
  const std::vector<MissionRecord> missions = station.missions();
  for (std::size_t i = 0; i < missions.size(); ++i) {
    if (const std::optional<ThermalMap> layer = station.loadLayer(i)) {
      if (missions[i].coloured == 0 && layer->surfaceCount() == 0) continue;  // geometry only
      add(result, station, missions[i], *layer, criteria);
    } else {
      result.without_layer.push_back(missions[i].name);
    }
  }
  if (result.missions.empty() && !result.without_layer.empty()) {
    add(result, station, allInOne(missions), station.loadMap(), criteria);
  }
  return result;
}

}  // namespace thermovox
