#include "apps/map_job.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "apps/imported_cloud.hpp"
#include "apps/mission_run.hpp"
#include "apps/radiometry_options.hpp"
#include "io/folders.hpp"
#include "io/mission_folder.hpp"
#include "io/rig_file.hpp"
#include "io/spilling_map.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

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
std::vector<OpenedMission> openMissions(const MapJob& job) {
  std::vector<OpenedMission> opened;
  MissionOptions options = missionOptions(job);
  options.warn = [](const std::string& warning) { spdlog::warn("{}", warning); };
  for (const fs::path& folder : job.missions) opened.push_back(openMission(folder, options));
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

/// How to wait for another process that writes the station: without end, for the mapping is done by then.
StationAccess accessOf(const MapJob& job) {
  const auto begins = [station = job.station.string()] {
    spdlog::info(
        "{}: waits for another process that is writing it, however long; to stop gives up the mapping",
        station);
  };
  return {.threads = job.threads, .patience = {.most = std::nullopt, .begins = begins}};
}

/// The station to continue; none when it is to be made. One that could not be written is refused before hours
/// of work, and so is a resolution that contradicts it.
std::optional<Station> existingStation(const MapJob& job) {
  if (!fs::exists(job.station)) {
    checkOutput(job.station, Existing::refuse);
    Station::checkWritable(job.station);
    return std::nullopt;
  }
  Station::checkWritable(job.station);
  Station station = Station::open(job.station, accessOf(job));
  if (job.resolution && *job.resolution != station.options().resolution) {
    throw ConfigError(job.station.string() + ": has cells of " +
                      std::to_string(station.options().resolution) + " m, --resolution asks for " +
                      std::to_string(*job.resolution) + " m, expected the same");
  }
  return station;
}

/// What the map needs to be made again from its missions; `scene` names those whose geometry the mission's
/// frames painted besides its own.
std::string parametersOf(const MapJob& job, const std::vector<std::string>& scene) {
  nlohmann::ordered_json json{{"carve", nameOf(job.mapper.carving)},
                              {"max_gap", job.max_gap},
                              {"two_pass", job.two_pass || job.paint},
                              {"paint", job.paint}};
  for (const fs::path& file : job.geometry) json["geometry"].push_back(cloudName(file));
  if (job.radiometry.any()) json["radiometry"] = jsonOf(job.radiometry);
  if (job.paint) json["scene"] = scene;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Before hours of work: a mission or cloud that the station has already, or that is named twice.
void checkNew(const std::vector<OpenedMission>& missions, const std::optional<Station>& station,
              const MapJob& job) {
  if (job.known == KnownMission::add_again) return;
  std::set<std::string> names;
  const auto check = [&](const std::string& name, const fs::path& place) {
    if (station) station->checkNew(name);
    if (names.insert(name).second) return;
    throw DataError(place.string() + ": is a second mission '" + name + "' for the station " +
                    job.station.string() + ", expected each name once (or --again to integrate both)");
  };
  for (const fs::path& file : job.geometry) check(cloudName(file), file);
  for (const OpenedMission& opened : missions) check(opened.mission.name, opened.folder);
}

MissionRecord recordOf(const OpenedMission& opened, const MissionReport& report, const MapJob& job,
                       const std::vector<std::string>& scene) {
  return {.name = report.mission,
          .rig = rigText(opened.mission.rig),
          .parameters = parametersOf(job, scene),
          .readings = static_cast<std::int64_t>(report.readings),
          .points = static_cast<std::int64_t>(report.points),
          .coloured = static_cast<std::int64_t>(report.coloured),
          .first = report.first_stamp,
          .last = report.last_stamp,
          .ambient = opened.mission.ambient,
          .pose_sigmas = {opened.mission.pose_rotation_sigma, opened.mission.pose_translation_sigma},
          .shared_motions = report.shared_motions,
          .frame_poses = report.frame_poses};
}

std::unique_ptr<PointsRecord> openRecord(const MapJob& job) {
  if (job.points.empty()) return nullptr;
  return std::make_unique<PointsRecord>(job.points, job.recorded, job.existing_points);
}

/// The maps of one run, in the order in which they were made, with what the station is to remember of them.
class Additions {
 public:
  /// The maps may take so many bytes together.
  Additions(const MapJob& job, const ThermalMap::Options& options, std::uint64_t memory_bytes)
      : job_(job), options_(options), memory_bytes_(memory_bytes) {}

  /// The map at work has half of the memory, once there are finished ones.
  ThermalMap& newMap() {
    for (SpillingMap& finished : maps_) finished.limitTo(memory_bytes_ / (2 * maps_.size()));
    SpillingMap& map = maps_.emplace_back(folderOf(job_.station), options_);
    map.map.setThreads(job_.threads);
    map.limitTo(maps_.size() > 1 ? memory_bytes_ / 2 : memory_bytes_);
    return map.map;
  }
  void add(MissionRecord record, const ThermalMap& map) {
    record.version = THERMOVOX_VERSION;
    record.mapped_at = job_.mapped_at;
    additions_.push_back({std::move(record), &map});
  }
  [[nodiscard]] std::vector<const ThermalMap*> maps() const {
    std::vector<const ThermalMap*> maps;
    for (const Station::Addition& addition : additions_) maps.push_back(addition.map);
    return maps;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Station::Addition& addition : additions_) names.push_back(addition.record.name);
    return names;
  }
  [[nodiscard]] std::size_t spilledTiles() const {
    std::size_t count = 0;
    for (const SpillingMap& spilling : maps_) count += spilling.map.spilledTiles();
    return count;
  }
  [[nodiscard]] std::span<const Station::Addition> all() const { return additions_; }

 private:
  const MapJob& job_;
  ThermalMap::Options options_;
  std::uint64_t memory_bytes_;
  std::deque<SpillingMap> maps_;  // whose places stay where they are
  std::vector<Station::Addition> additions_;
};

/// The station as it was, for frames to paint.
struct Before {
  SpillingMap map;
  std::vector<std::string> names;  ///< of its missions

  Before(const MapJob& job, const Station& station) : map(folderOf(job.station), station.options()) {
    map.limitTo(job.memory_bytes / 2);
    station.loadInto(map.map);
    for (const MissionRecord& mission : station.missions()) names.push_back(mission.name);
  }
};

/// Maps the missions in the order of their flights. What hides things from a mission besides its own geometry
/// are the imported clouds; with --paint also the station as it was and the missions before it.
std::vector<MissionReport> mapMissions(std::vector<OpenedMission>& missions, const MapJob& job,
                                       const Before* before, Additions& additions, PointsRecord* record) {
  for (const fs::path& file : job.geometry) {
    ThermalMap& map = additions.newMap();
    additions.add(importCloud(file, map), map);
  }
  const std::vector<const ThermalMap*> clouds = additions.maps();
  std::vector<MissionReport> reports(missions.size());
  for (const std::size_t place : flightOrder(missions)) {
    std::vector<const ThermalMap*> known = job.paint ? additions.maps() : clouds;
    std::vector<std::string> names = before != nullptr ? before->names : std::vector<std::string>();
    for (std::string& name : additions.names()) names.push_back(std::move(name));
    if (before != nullptr) known.push_back(&before->map.map);
    ThermalMap& map = additions.newMap();
    reports[place] = mapOne(missions[place], job, std::move(known), map, record);
    additions.add(recordOf(missions[place], reports[place], job, names), map);
  }
  return reports;
}

}  // namespace

ThermalMap::Options newStationOptions(const MapJob& job) {
  ThermalMap::Options options;
  if (job.resolution) options.resolution = *job.resolution;
  return options;
}

MapResult run(MapJob& job) {
  std::vector<OpenedMission> missions = openMissions(job);
  if (job.station.empty()) {
    job.station =
        (missions.empty() ? cloudName(job.geometry.front()) : missions.front().mission.name) + ".tvx";
  }
  std::optional<Station> station = existingStation(job);
  checkNew(missions, station, job);
  const std::unique_ptr<PointsRecord> points = openRecord(job);
  const ThermalMap::Options options = station ? station->options() : newStationOptions(job);
  std::optional<Before> before;
  if (job.paint && station) before.emplace(job, *station);
  Additions additions(job, options, job.memory_bytes / (before ? 2 : 1));
  MapResult result;
  result.missions = mapMissions(missions, job, before ? &*before : nullptr, additions, points.get());
  if (points) points->finish();
  if (!station) station.emplace(Station::create(job.station, options, accessOf(job)));
  station->addMissions(additions.all(), job.known);
  if (points) points->commit();
  result.voxels = static_cast<std::size_t>(station->counts().surfaces);
  result.spilled_tiles = additions.spilledTiles() + (before ? before->map.map.spilledTiles() : 0);
  return result;
}

}  // namespace thermovox
