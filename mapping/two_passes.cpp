#include "mapping/two_passes.hpp"

#include <utility>

#include "projection/error.hpp"

namespace thermovox {

MissionReport mapMissionTwice(const TwoPasses& passes, ThermalMap& map, std::vector<const ThermalMap*> known,
                              MissionMapper::Options options) {
  const MissionMapper::Pass second = std::exchange(options.pass, MissionMapper::Pass::only);
  if (second == MissionMapper::Pass::only)
    throw ConfigError("two passes: found the pass 'only', expected the second to be 'colours' or 'paint'");
  options.scene = nullptr;
  const MissionStreams& first = passes.geometry;
  (void)mapMission({first.mission, first.readings, nullptr}, map, options, passes.geometry_listeners);
  known.push_back(&map);
  SceneSurfaces scene(std::move(known));
  options.pass = second;
  options.scene = &scene;
  return mapMission(passes.look, map, options, passes.look_listeners);
}

}  // namespace thermovox
