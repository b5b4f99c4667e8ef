#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "apps/progress.hpp"
#include "apps/verbs.hpp"
#include "io/mission_folder.hpp"
#include "io/points_record.hpp"
#include "io/rig_file.hpp"
#include "io/station.hpp"
#include "mapping/mission_mapper.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, Carving> kCarvings{{"octomap", Carving::octomap}, {"none", Carving::none}};

constexpr double kLongestGap = 1e7;  // seconds

struct MapArgs {
  std::vector<fs::path> missions;
  fs::path station;
  std::optional<double> resolution;
  fs::path points;
  RecordedPoints recorded = RecordedPoints::coloured;
  double max_gap = toSeconds(Trajectory::kDefaultMaxGap);
  MissionMapper::Options mapper;
  KnownMission known = KnownMission::refuse;
  bool force = false;
  bool json = false;
  std::int64_t mapped_at = 0;  ///< Unix seconds
};

struct MapResult {
  std::vector<MissionReport> missions;
  std::size_t voxels = 0;
  double seconds = 0.0;

  [[nodiscard]] double pointsPerSecond() const {
    std::size_t points = 0;
    for (const MissionReport& mission : missions) points += mission.points;
    return seconds > 0.0 ? static_cast<double>(points) / seconds : 0.0;
  }
};

/// All missions, in the order of their flights: the result then does not depend on how they were named.
std::vector<OpenedMission> openMissions(const MapArgs& args) {
  std::vector<OpenedMission> opened;
  const MissionOptions options{.max_gap = durationFromSeconds(args.max_gap)};
  for (const fs::path& folder : args.missions) opened.push_back(openMission(folder, options));
  std::stable_sort(opened.begin(), opened.end(), [](const OpenedMission& a, const OpenedMission& b) {
    const auto key = [](const OpenedMission& m) {
      return std::pair(m.mission.trajectory.poses().front().stamp, m.mission.name);
    };
    return key(a) < key(b);
  });
  return opened;
}

/// Colours were to be expected, and there is not one: most likely the rig or a clock is wrong.
void checkColours(const MissionReport& report, bool frames_expected) {
  if (!frames_expected || report.coloured > 0) return;
  const auto most = std::max_element(report.uncoloured.begin(), report.uncoloured.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::string reason = most == report.uncoloured.end() ? "no_frame" : most->first;
  const std::string likely = reason == "no_frame" || reason == "no_pose_for_frame"
                                 ? "check the clocks of camera and laser, and camera_time_offset"
                                 : "check T_body_camera and T_body_laser of the rig";
  throw DataError("mission " + report.mission + ": none of its " + std::to_string(report.points) +
                  " points got a temperature (most: " + reason + "); " + likely);
}

MissionReport mapOne(OpenedMission& opened, const MapArgs& args, ThermalMap& map, PointsRecord* points) {
  const Trajectory& trajectory = opened.mission.trajectory;
  Progress progress("mapping " + opened.mission.name, trajectory.poses().front().stamp,
                    trajectory.poses().back().stamp);
  MissionListeners listeners{.progress = [&progress](Time stamp) { progress.at(stamp); }};
  if (points != nullptr)
    listeners.points = [points](std::span<const ColouredReturn> reading) { points->add(reading); };
  const MissionReport report =
      mapMission({opened.mission, *opened.readings, opened.frames.get()}, map, args.mapper, listeners);
  checkColours(report, opened.frames != nullptr);
  if (points != nullptr) points->flush();  // a full disk shows before the station has the mission
  return report;
}

nlohmann::ordered_json missionJson(const MissionReport& report) {
  return {{"mission", report.mission},   {"readings", report.readings},     {"points", report.points},
          {"coloured", report.coloured}, {"uncoloured", report.uncoloured}, {"dropped", report.dropped}};
}

void printJson(const MapResult& result) {
  nlohmann::ordered_json json;
  json["missions"] = nlohmann::ordered_json::array();
  for (const MissionReport& report : result.missions) json["missions"].push_back(missionJson(report));
  if (result.missions.size() == 1) json.update(missionJson(result.missions.front()));
  json["voxels"] = result.voxels;
  json["seconds"] = result.seconds;
  json["points_per_second"] = result.pointsPerSecond();
  std::cout << json.dump(2) << '\n';
}

void printCounts(const char* title, const std::map<std::string, std::size_t>& counts) {
  if (counts.empty()) return;
  std::cout << "  " << title;
  const char* separator = " ";
  for (const auto& [reason, n] : counts) {
    std::cout << separator << reason << ' ' << n;
    separator = ", ";
  }
  std::cout << '\n';
}

void printText(const MapResult& result, const fs::path& station) {
  for (const MissionReport& report : result.missions) {
    std::cout << report.mission << ": " << report.readings << " readings, " << report.points << " points, "
              << report.coloured << " with a temperature\n";
    printCounts("without:", report.uncoloured);
    printCounts("dropped:", report.dropped);
  }
  std::cout << station.string() << ": " << result.voxels << " cells hold a surface, mapped in "
            << result.seconds << " s\n";
}

/// The station to continue, or a new one. A resolution that contradicts an existing station is refused.
Station openStation(const MapArgs& args) {
  if (!fs::exists(args.station)) {
    ThermalMap::Options options;
    if (args.resolution) options.resolution = *args.resolution;
    return Station::create(args.station, options);
  }
  Station station = Station::open(args.station);
  if (args.resolution && *args.resolution != station.options().resolution) {
    throw ConfigError(args.station.string() + ": has cells of " +
                      std::to_string(station.options().resolution) + " m, --resolution asks for " +
                      std::to_string(*args.resolution) + " m, expected the same");
  }
  return station;
}

/// What the map needs to be made again from its missions.
std::string parametersOf(const MapArgs& args) {
  const nlohmann::ordered_json json{{"carve", args.mapper.carving == Carving::octomap ? "octomap" : "none"},
                                    {"max_gap", args.max_gap}};
  return json.dump();
}

/// Before hours of work: a mission that the station has already, or that is named twice.
void checkNew(const std::vector<OpenedMission>& missions, const Station& station) {
  std::set<std::string> names;
  for (const OpenedMission& opened : missions) {
    const std::string& name = opened.mission.name;
    station.checkNew(name);
    if (names.insert(name).second) continue;
    throw DataError(opened.folder.string() + ": is a second mission '" + name + "' for the station " +
                    station.path().string() + ", expected each name once (or --again to integrate both)");
  }
}

/// Unix seconds of now, or SOURCE_DATE_EPOCH where it is set, so that the same input gives the same bytes.
std::int64_t mappingTime() {
  const char* fixed = std::getenv("SOURCE_DATE_EPOCH");
  if (fixed == nullptr) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::seconds>(now).count();
  }
  const std::string_view text = fixed;
  std::int64_t seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || seconds < 0) {
    throw ConfigError("SOURCE_DATE_EPOCH: found '" + std::string(text) + "', expected whole Unix seconds");
  }
  return seconds;
}

MissionRecord recordOf(const OpenedMission& opened, const MissionReport& report, const MapArgs& args) {
  return {.name = report.mission,
          .rig = rigText(opened.mission.rig),
          .parameters = parametersOf(args),
          .readings = static_cast<std::int64_t>(report.readings),
          .points = static_cast<std::int64_t>(report.points),
          .coloured = static_cast<std::int64_t>(report.coloured),
          .first = report.first_stamp,
          .last = report.last_stamp,
          .version = THERMOVOX_VERSION,
          .mapped_at = args.mapped_at};
}

void runMap(MapArgs& args) {
  const auto begin = std::chrono::steady_clock::now();
  if (!(args.max_gap > 0.0 && args.max_gap <= kLongestGap)) {
    throw ConfigError("--max-gap: found " + std::to_string(args.max_gap) +
                      " s, expected more than 0 and at most " + std::to_string(kLongestGap) + " s");
  }
  args.mapped_at = mappingTime();
  std::vector<OpenedMission> missions = openMissions(args);
  if (args.station.empty()) args.station = missions.front().mission.name + ".tvx";
  std::unique_ptr<PointsRecord> points;
  if (!args.points.empty()) {
    points = std::make_unique<PointsRecord>(args.points, args.recorded,
                                            args.force ? Existing::replace : Existing::refuse);
  }
  MapResult result;
  Station station = openStation(args);
  if (args.known == KnownMission::refuse) checkNew(missions, station);
  for (OpenedMission& opened : missions) {
    ThermalMap map(station.options());
    result.missions.push_back(mapOne(opened, args, map, points.get()));
    station.addMission(recordOf(opened, result.missions.back(), args), map, args.known);
  }
  result.voxels = static_cast<std::size_t>(station.counts().surfaces);
  if (points) points->commit();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (args.json) {
    printJson(result);
  } else {
    printText(result, args.station);
  }
}

}  // namespace

void addMap(CLI::App& app) {
  auto args = std::make_shared<MapArgs>();
  CLI::App* verb = app.add_subcommand(
      "map",
      "Colour every laser point of a mission with its temperature and integrate it into a station's map.");
  verb->add_option("MISSION", args->missions, "Mission folders")->required();
  verb->add_option(
      "--station", args->station,
      "Station to write or to continue (default: NAME.tvx of the first mission in the current folder)");
  verb->add_option("--resolution", args->resolution, "Edge of a cell of a new station [m] (default 0.05)");
  verb->add_option("--points", args->points, "Record of every coloured point, in time order (.csv or .ply)");
  verb->add_flag_callback(
      "--all-points", [args] { args->recorded = RecordedPoints::all; },
      "Record the points without temperature too, with empty fields");
  verb->add_option("--carve", args->mapper.carving,
                   "Which cells a ray frees: octomap (all before its return) or none (default octomap)")
      ->transform(CLI::CheckedTransformer(kCarvings));
  verb->add_option("--max-gap", args->max_gap, "Longest time without poses that is interpolated [s]")
      ->capture_default_str();
  verb->add_flag_callback(
      "--again", [args] { args->known = KnownMission::add_again; },
      "Integrate a mission although the station has one of that name");
  verb->add_flag("--force", args->force, "Replace a points record that is there");
  verb->add_flag("--json", args->json, "Print the account as JSON");
  verb->callback([args] { runMap(*args); });
}

}  // namespace thermovox
