#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/map_report.hpp"
#include "apps/progress.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
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

/// Temperatures need a camera in the rig and images in the mission: one without the other may be a slip.
void warnOfHalfACamera(const OpenedMission& opened) {
  const bool camera = opened.mission.rig.thermal_camera.has_value();
  if (camera && !opened.thermal_list) {
    spdlog::warn("{} has a thermal camera, but {} lists no thermal images: the map gets no temperatures",
                 opened.rig_file.string(), opened.file.string());
  } else if (!camera && opened.thermal_list) {
    spdlog::warn("{} lists thermal images, but {} has no thermal_camera: the map gets no temperatures",
                 opened.file.string(), opened.rig_file.string());
  }
}

/// All missions, in the order of their names on the command line.
std::vector<OpenedMission> openMissions(const MapArgs& args) {
  std::vector<OpenedMission> opened;
  const MissionOptions options{.max_gap = durationFromSeconds(args.max_gap)};
  for (const fs::path& folder : args.missions) opened.push_back(openMission(folder, options));
  for (const OpenedMission& mission : opened) warnOfHalfACamera(mission);
  return opened;
}

/// The missions' places in the order of their flights: in which they are mapped, so that the result does not
/// depend on how they were named.
std::vector<std::size_t> flightOrder(const std::vector<OpenedMission>& missions) {
  const auto key = [&](std::size_t i) {
    const Mission& mission = missions[i].mission;
    return std::pair(mission.trajectory.poses().front().stamp, mission.name);
  };
  std::vector<std::size_t> order(missions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
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
  return report;
}

/// Of a new station.
ThermalMap::Options newOptions(const MapArgs& args) {
  ThermalMap::Options options;
  if (args.resolution) options.resolution = *args.resolution;
  return options;
}

/// The station to continue; none when it is to be made. A resolution that contradicts it is refused.
std::optional<Station> existingStation(const MapArgs& args) {
  if (!fs::exists(args.station)) {
    checkOutput(args.station, Existing::refuse);
    return std::nullopt;
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
void checkNew(const std::vector<OpenedMission>& missions, const std::optional<Station>& station,
              const MapArgs& args) {
  if (args.known == KnownMission::add_again) return;
  std::set<std::string> names;
  for (const OpenedMission& opened : missions) {
    const std::string& name = opened.mission.name;
    if (station) station->checkNew(name);
    if (names.insert(name).second) continue;
    throw DataError(opened.folder.string() + ": is a second mission '" + name + "' for the station " +
                    args.station.string() + ", expected each name once (or --again to integrate both)");
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

void checkUsage(const MapArgs& args) {
  if (!(args.max_gap > 0.0 && args.max_gap <= kLongestGap)) {
    throw UsageError("--max-gap: found " + std::to_string(args.max_gap) +
                     " s, expected more than 0 and at most " + std::to_string(kLongestGap) + " s");
  }
  if (!args.points.empty()) checkEnding(args.points, {".csv", ".ply"});
  try {
    newOptions(args).validate();
  } catch (const ConfigError& error) {
    throw UsageError(std::string("--resolution: ") + error.what());
  }
}

std::unique_ptr<PointsRecord> openRecord(const MapArgs& args) {
  if (args.points.empty()) return nullptr;
  return std::make_unique<PointsRecord>(args.points, args.recorded,
                                        args.force ? Existing::replace : Existing::refuse);
}

/// Maps all missions, and only then puts them into the station, all at once: whatever fails on the way leaves
/// the station as it was.
MapResult mapAll(std::vector<OpenedMission>& missions, const MapArgs& args) {
  std::optional<Station> station = existingStation(args);
  checkNew(missions, station, args);
  const std::unique_ptr<PointsRecord> points = openRecord(args);
  const ThermalMap::Options options = station ? station->options() : newOptions(args);
  MapResult result;
  result.missions.resize(missions.size());
  std::deque<ThermalMap> maps;  // whose places stay where they are
  std::vector<Station::Addition> additions;
  for (const std::size_t place : flightOrder(missions)) {
    ThermalMap& map = maps.emplace_back(options);
    result.missions[place] = mapOne(missions[place], args, map, points.get());
    additions.push_back({recordOf(missions[place], result.missions[place], args), &map});
  }
  if (points) points->finish();
  if (!station) station.emplace(Station::create(args.station, options));
  station->addMissions(additions, args.known);
  if (points) points->commit();
  result.voxels = static_cast<std::size_t>(station->counts().surfaces);
  return result;
}

void runMap(MapArgs& args) {
  const auto begin = std::chrono::steady_clock::now();
  checkUsage(args);
  args.mapped_at = mappingTime();
  std::vector<OpenedMission> missions = openMissions(args);
  if (args.station.empty()) args.station = missions.front().mission.name + ".tvx";
  MapResult result = mapAll(missions, args);
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
  addChoice(*verb, "--carve", args->mapper.carving, kCarvings,
            "Which cells a ray frees: octomap (all before its return) or none (default octomap)");
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
