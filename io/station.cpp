#include "io/station.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/station_file.hpp"
#include "io/station_schema.hpp"
#include "io/station_tiles.hpp"
#include "io/station_writer.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

void checkNewName(const MissionRecord& known, const std::string& name, const fs::path& path) {
  if (known.name != name) return;
  throw DataError(path.string() + ": has the mission '" + name +
                  "' already, expected one of another name (or --again to integrate it once more)");
}

void checkOptions(const ThermalMap::Options& of_map, const ThermalMap::Options& of_station,
                  const fs::path& path) {
  if (of_map == of_station) return;
  throw ConfigError(path.string() + ": has cells of " + std::to_string(of_station.resolution) +
                    " m, expected a map of the same resolution and occupancy model (it has " +
                    std::to_string(of_map.resolution) + " m)");
}

void checkAddition(const Station::Addition& addition, const StationContent& content, KnownMission known,
                   const fs::path& path) {
  const auto& [record, map] = addition;
  checkOptions(map->options(), content.options, path);
  if (known == KnownMission::add_again) return;
  for (const StationContent::Mission& mission : content.missions)
    checkNewName(mission.record, record.name, path);
}

}  // namespace

Station::Station(fs::path path, const ThermalMap::Options& options, StationAccess access)
    : path_(std::move(path)), options_(options), access_(std::move(access)) {}
Station::Station(Station&&) noexcept = default;
Station& Station::operator=(Station&&) noexcept = default;
Station::~Station() = default;

Station Station::open(const fs::path& path, StationAccess access) {
  Station station(path, {}, std::move(access));
  station.read();
  return station;
}

void Station::read() {
  database_ = std::make_unique<SqlDatabase>(openStation(path_));
  options_ = readStationOptions(*database_, path_);
}

Station Station::create(const fs::path& path, const ThermalMap::Options& options, StationAccess access) {
  options.validate();
  checkOutput(path, Existing::refuse);
  checkWritable(path);
  return {path, options, std::move(access)};
}

void Station::checkWritable(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
    throw DataError(path.string() + ": is write-protected, expected a station that can be continued");
  const StationWriter writer(path);
}

Station::Counts Station::counts() const {
  return database_ ? countStation(*database_) : Counts{};
}

std::vector<MissionRecord> Station::missions() const {
  return database_ ? readMissions(*database_, path_) : std::vector<MissionRecord>{};
}

ThermalMap Station::loadMap() const {
  ThermalMap map(options_);
  loadInto(map);
  return map;
}

void Station::loadInto(ThermalMap& map) const {
  checkOptions(map.options(), options_, path_);
  if (!database_) return;
  StationTiles tiles(*database_, path_);
  loadTiles(tiles, path_, access_.threads, map);
}

std::optional<ThermalMap> Station::loadLayer(std::size_t place) const {
  const auto id = static_cast<std::int64_t>(place) + 1;
  if (!database_ || !hasLayer(*database_, id)) return std::nullopt;
  ThermalMap layer(options_);
  StationTiles tiles(*database_, path_, id);
  loadTiles(tiles, path_, access_.threads, layer);
  return layer;
}

void Station::checkNew(const std::string& mission) const {
  for (const MissionRecord& known : missions()) checkNewName(known, mission, path_);
}

void Station::addMission(const MissionRecord& record, const ThermalMap& mission_map, KnownMission known) {
  const std::array<Addition, 1> one{{{record, &mission_map}}};
  addMissions(one, known);
}

void Station::addMissions(std::span<const Addition> additions, KnownMission known) {
  for (bool done = false; !done;) {
    StationContent content{.options = options_};
    std::unique_ptr<SqlDatabase> there;  // and locked
    if (database_ || fs::exists(path_)) {
      checkWritable(path_);
      there = lockStation(path_, access_.patience);
      checkStationTables(*there, path_);
      checkCounts(*there, path_);
      content.options = readStationOptions(*there, path_);
      content.missions = storedMissions(*there, path_);
      content.sources.push_back(std::make_unique<StationTiles>(*there, path_));
    }
    for (const Addition& addition : additions) {
      checkAddition(addition, content, known, path_);
      content.missions.push_back({addition.record, std::make_unique<LayerTiles>(*addition.map)});
      content.sources.push_back(std::make_unique<MapTiles>(*addition.map));
    }
    StationWriter writer(path_);
    writer.write(std::move(content), access_.threads);
    if (there) writer.publishOver();
    done = there || writer.publishNew();
  }
  read();
}

std::vector<std::string> Station::verify() const {
  std::vector<std::string> faults;
  if (!database_) return faults;
  const auto note = [&faults](const auto& check) {
    try {
      check();
    } catch (const DataError& error) {
      faults.emplace_back(error.what());
    }
  };
  note([&] {
    SqlStatement check = database_->prepare("PRAGMA integrity_check(20)");
    while (check.step()) {
      if (check.text(0) != "ok") faults.push_back(path_.string() + ": " + check.text(0));
    }
  });
  note([&] { checkCounts(*database_, path_); });
  note([&] { (void)missions(); });
  note([&] {
    const auto verifyTiles = [&](StationTiles tiles) {
      forEachDecodedTile(tiles, path_, access_.threads, [&](TileBlocks&, const std::string& fault) {
        if (!fault.empty()) faults.push_back(fault);
      });
    };
    verifyTiles(StationTiles(*database_, path_));
    for (std::int64_t id = 1; id <= countStation(*database_).missions; ++id) {
      if (hasLayer(*database_, id)) verifyTiles(StationTiles(*database_, path_, id));
    }
  });
  return faults;
}

}  // namespace thermovox
