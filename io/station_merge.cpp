#include "io/station_merge.hpp"

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "io/number_text.hpp"
#include "io/sqlite.hpp"
#include "io/station_schema.hpp"
#include "io/station_tiles.hpp"
#include "io/station_writer.hpp"
#include "mapping/moved_map.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace fs = std::filesystem;
namespace {

/// What the stations become, while it is put together; the databases and maps are what its sources read.
struct Merge {
  std::deque<SqlDatabase> databases;
  std::deque<ThermalMap> moved;
  StationContent content;
  std::string frame;
  std::map<std::string, fs::path> station_of;  ///< by the mission's name
};

void checkSameCells(const Merge& merge, const MergeInput& input, const MergeInput& first,
                    const ThermalMap::Options& options, const std::string& frame) {
  const ThermalMap::Options& expected = merge.content.options;
  const std::string other = first.station.string();
  if (options.resolution != expected.resolution) {
    throw ConfigError(input.station.string() + ": has cells of " + exactText(options.resolution) +
                      " m, expected " + exactText(expected.resolution) + " m as in " + other);
  }
  if (options.occupancy != expected.occupancy)
    throw ConfigError(input.station.string() + ": has another occupancy model, expected that of " + other);
  if (frame != merge.frame) {
    throw ConfigError(input.station.string() + ": has the frame " + inQuotes(frame) + ", expected " +
                      inQuotes(merge.frame) + " as in " + other);
  }
}

void addMissions(Merge& merge, const MergeInput& input, std::vector<MissionRecord> missions) {
  for (MissionRecord& mission : missions) {
    const auto [known, is_new] = merge.station_of.emplace(mission.name, input.station);
    if (!is_new && known->second != input.station) {
      throw DataError("the mission " + inQuotes(mission.name) + " is in both " + known->second.string() +
                      " and " + input.station.string() + ", expected each mission in one station");
    }
    if (input.T_world_station) {
      mission.T_world_mission = mission.T_world_mission ? *input.T_world_station * *mission.T_world_mission
                                                        : *input.T_world_station;
    }
    merge.content.missions.push_back(std::move(mission));
  }
}

ThermalMap movedStation(const MergeInput& input, int threads) {
  try {
    return movedMap(Station::open(input.station, {.threads = threads}).loadMap(), *input.T_world_station);
  } catch (const DataError& error) {
    const std::string name = input.station.string();
    const std::string what = error.what();
    throw DataError(what.starts_with(name) ? what : name + ": " + what);
  }
}

void addStation(Merge& merge, const MergeInput& input, const MergeInput& first, int threads) {
  const ThermalMap::Options options = Station::open(input.station).options();  // and checks what it is
  const SqlDatabase& database =
      merge.databases.emplace_back(input.station, SqlDatabase::Mode::read, input.station.string());
  checkCounts(database, input.station);
  const std::string frame = readStationFrame(database, input.station);
  if (&input == &first) {
    merge.content.options = options;
    merge.frame = frame;
  }
  checkSameCells(merge, input, first, options, frame);
  addMissions(merge, input, readMissions(database, input.station));
  if (input.T_world_station) {
    const ThermalMap& map = merge.moved.emplace_back(movedStation(input, threads));
    merge.content.sources.push_back(std::make_unique<MapTiles>(map));
  } else {
    merge.content.sources.push_back(std::make_unique<StationTiles>(database, input.station));
  }
}

void checkIsNoInput(const fs::path& output, std::span<const MergeInput> inputs) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::error_code ignored;
    if (fs::equivalent(output, inputs[i].station, ignored))
      throw DataError(output.string() + ": is one of the stations to merge, expected another name");
    for (std::size_t j = 0; j < i; ++j) {
      if (fs::equivalent(inputs[i].station, inputs[j].station, ignored))
        throw DataError(inputs[i].station.string() + ": is given twice, expected each station once");
    }
  }
}

}  // namespace

Station::Counts mergeStations(std::span<const MergeInput> inputs, const fs::path& output, Existing existing,
                              int threads) {
  if (inputs.empty()) throw ConfigError("no station is given to merge, expected one or more");
  checkIsNoInput(output, inputs);
  checkOutput(output, existing);
  StationWriter writer(output);
  Merge merge;
  for (const MergeInput& input : inputs) addStation(merge, input, inputs.front(), threads);
  writer.write(std::move(merge.content), threads);
  if (existing == Existing::replace) {
    writer.publishOver();
  } else if (!writer.publishNew()) {
    checkOutput(output, existing);
  }
  return Station::open(output).counts();
}

}  // namespace thermovox
