#include "io/station_merge.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "io/folders.hpp"
#include "io/number_text.hpp"
#include "io/spilling_map.hpp"
#include "io/sqlite.hpp"
#include "io/station_file.hpp"
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
  std::deque<SpillingMap> moved;
  StationContent content;
  std::string frame;
  std::map<std::string, fs::path> station_of;  ///< by the mission's name
  fs::path folder;                             ///< of the output
  int threads = 0;
  std::uint64_t map_bytes = 0;  ///< that each map may take
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

const ThermalMap& movedTiles(Merge& merge, StationTiles tiles, const MergeInput& input) {
  SpillingMap before(merge.folder, merge.content.options);
  before.limitTo(merge.map_bytes);
  loadTiles(tiles, input.station, merge.threads, before.map);
  SpillingMap& moved = merge.moved.emplace_back(merge.folder, merge.content.options);
  moved.limitTo(merge.map_bytes);
  try {
    addMoved(before.map, *input.T_world_station, moved.map);
  } catch (const DataError& error) {
    throw DataError(input.station.string() + ": " + error.what());
  }
  return moved.map;
}

/// A mission goes with its station.
void move(Merge& merge, const SqlDatabase& database, const MergeInput& input,
          StationContent::Mission& mission, std::int64_t id) {
  MissionRecord& record = mission.record;
  record.T_world_mission =
      record.T_world_mission ? *input.T_world_station * *record.T_world_mission : *input.T_world_station;
  try {
    record.shared_motions = moved(record.shared_motions, *input.T_world_station);
  } catch (const DataError& error) {
    throw DataError(input.station.string() + ": " + error.what());
  }
  for (FramePose& frame : record.frame_poses) {
    frame.T_world_camera = *input.T_world_station * frame.T_world_camera;
  }
  if (!mission.layer) return;
  mission.layer =
      std::make_unique<LayerTiles>(movedTiles(merge, StationTiles(database, input.station, id), input));
}

void addMissions(Merge& merge, const SqlDatabase& database, const MergeInput& input) {
  std::int64_t id = 0;
  for (StationContent::Mission& stored : storedMissions(database, input.station)) {
    const MissionRecord& mission = stored.record;
    const auto [known, is_new] = merge.station_of.emplace(mission.name, input.station);
    if (!is_new && known->second != input.station) {
      throw DataError("the mission " + inQuotes(mission.name) + " is in both " + known->second.string() +
                      " and " + input.station.string() + ", expected each mission in one station");
    }
    ++id;
    if (input.T_world_station) move(merge, database, input, stored, id);
    merge.content.missions.push_back(std::move(stored));
  }
}

void addStation(Merge& merge, const MergeInput& input, const MergeInput& first) {
  // Opened once: another process may replace it meanwhile.
  const SqlDatabase& database = merge.databases.emplace_back(openStation(input.station));
  checkCounts(database, input.station);
  const ThermalMap::Options options = readStationOptions(database, input.station);
  const std::string frame = readStationFrame(database, input.station);
  if (&input == &first) {
    merge.content.options = options;
    merge.frame = frame;
  }
  checkSameCells(merge, input, first, options, frame);
  addMissions(merge, database, input);
  if (input.T_world_station) {
    merge.content.sources.push_back(
        std::make_unique<MapTiles>(movedTiles(merge, StationTiles(database, input.station), input)));
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

/// What the output is to hold. The databases that it is read from come with it.
Merge mergeOf(std::span<const MergeInput> inputs, const fs::path& output, const MergeWork& work) {
  const auto moved =
      static_cast<std::uint64_t>(std::count_if(inputs.begin(), inputs.end(), [](const MergeInput& input) {
        return input.T_world_station.has_value();
      }));
  Merge merge;
  merge.folder = folderOf(output);
  merge.threads = work.threads;
  merge.map_bytes = work.memory_bytes / (moved + 1);  // one is moved at a time, and all that were stay
  for (const MergeInput& input : inputs) addStation(merge, input, inputs.front());
  return merge;
}

/// Keeps others from writing a station that is there; null when none is.
std::unique_ptr<SqlDatabase> lockThere(const fs::path& output, const StationPatience& patience) {
  return isDatabase(output) ? lockStation(output, patience) : nullptr;
}

}  // namespace

Station::Counts mergeStations(std::span<const MergeInput> inputs, const fs::path& output, Existing existing,
                              const MergeWork& work) {
  if (inputs.empty()) throw ConfigError("no station is given to merge, expected one or more");
  checkIsNoInput(output, inputs);
  checkOutput(output, existing);
  const std::unique_ptr<SqlDatabase> there = lockThere(output, work.patience);
  StationWriter writer(output);
  {
    Merge merge = mergeOf(inputs, output, work);
    writer.write(std::move(merge.content), work.threads);
  }
  if (there) {
    writer.publishOver();
    return Station::open(output).counts();
  }
  while (!writer.publishNew()) {
    checkOutput(output, existing);
    if (existing == Existing::refuse) continue;  // it has gone again
    const std::unique_ptr<SqlDatabase> meanwhile = lockThere(output, work.patience);
    writer.publishOver();
    break;
  }
  return Station::open(output).counts();
}

}  // namespace thermovox
