#include "apps/mission_run.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "apps/progress.hpp"
#include "mapping/two_passes.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Colours were to be expected, and there is not one: most likely the rig or a clock is wrong.
void checkColours(const MissionReport& report, bool frames_expected) {
  if (!frames_expected || report.coloured > 0 || report.painted > 0) return;
  const auto most = std::max_element(report.uncoloured.begin(), report.uncoloured.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::string reason = most == report.uncoloured.end() ? "no_frame" : most->first;
  const std::string likely = reason == "no_frame" || reason == "no_pose_for_frame"
                                 ? "check the clocks of camera and laser, and camera_time_offset"
                                 : "check T_body_camera and T_body_laser of the rig";
  throw DataError("mission " + report.mission + ": none of its " + std::to_string(report.points) +
                  " points got a temperature (most: " + reason + "); " + likely);
}

Progress progressOf(const OpenedMission& opened, const std::string& pass) {
  const std::span<const StampedPose> poses = opened.mission.trajectory.poses();
  return {"mapping " + opened.mission.name + pass, poses.front().stamp, poses.back().stamp};
}

MissionListeners listenersWith(Progress& progress, MissionMapper::Sink points) {
  return {.points = std::move(points), .progress = [&progress](Time stamp) { progress.at(stamp); }};
}

MissionStreams streamsOf(OpenedMission& opened) {
  return {opened.mission, *opened.readings, opened.frames.get()};
}

/// `known` is the geometry besides the mission's own.
MissionReport mapOnce(OpenedMission& opened, const MapJob& job, std::vector<const ThermalMap*> known,
                      ThermalMap& map, const MissionMapper::Sink& points) {
  std::optional<SceneSurfaces> scene;
  MissionMapper::Options options = job.mapper;
  if (!known.empty()) options.scene = &scene.emplace(std::move(known));
  Progress progress = progressOf(opened, "");
  return mapMission(streamsOf(opened), map, options, listenersWith(progress, points));
}

MissionReport mapTwice(OpenedMission& opened, const MapJob& job, std::vector<const ThermalMap*> known,
                       ThermalMap& map, const MissionMapper::Sink& points) {
  OpenedMission again = openMission(opened.folder, missionOptions(job));
  Progress first = progressOf(opened, ", pass 1 of 2"), second = progressOf(opened, ", pass 2 of 2");
  MissionMapper::Options options = job.mapper;
  options.pass = job.paint ? MissionMapper::Pass::paint : MissionMapper::Pass::colours;
  const TwoPasses passes{.geometry = streamsOf(again),
                         .look = streamsOf(opened),
                         .geometry_listeners = listenersWith(first, {}),
                         .look_listeners = listenersWith(second, points)};
  return mapMissionTwice(passes, map, std::move(known), options);
}

}  // namespace

MissionOptions missionOptions(const MapJob& job) {
  return {.max_gap = durationFromSeconds(job.max_gap), .radiometry = job.radiometry};
}

MissionReport mapOne(OpenedMission& opened, const MapJob& job, std::vector<const ThermalMap*> known,
                     ThermalMap& map, PointsRecord* record) {
  MissionMapper::Sink points;
  if (record != nullptr) points = [record](std::span<const ColouredReturn> reading) { record->add(reading); };
  const bool twice = (job.two_pass || job.paint) && opened.frames;
  const MissionReport report = twice ? mapTwice(opened, job, std::move(known), map, points)
                                     : mapOnce(opened, job, std::move(known), map, points);
  checkColours(report, opened.frames != nullptr);
  warnOfCalibration(report);
  return report;
}

}  // namespace thermovox
