// A whole mission, from its files to the map: hall-cloud of the recordings at 0.05 m, as a multiple of the
// time the sensors took to measure it, and against OctoMap's insertPointCloud for the very same returns
// (their first sweeps only: OctoMap needs seconds for each).

#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include "io/mission_folder.hpp"
#include "mapping/mission_mapper.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

constexpr double kResolution = 0.05;      // metres
constexpr std::size_t kPeerReadings = 6;  // of the mission's 60

std::filesystem::path missionFolder() {
  const auto data = test::recordings();
  return data ? *data / "missions" / "hall-cloud" : std::filesystem::path();
}

/// The returns of the mission in the world, reading by reading.
std::vector<std::vector<PlacedReturn>> placedReadings(std::size_t most) {
  const OpenedMission opened = openMission(missionFolder());
  std::vector<std::vector<PlacedReturn>> readings;
  while (readings.size() < most) {
    const std::optional<Reading> reading = opened.readings->next();
    if (!reading) break;
    readings.emplace_back();
    for (const LaserReturn& laser_return : reading->returns) {
      const auto placed = place(laser_return, opened.mission.rig.lasers[reading->laser], opened.mission);
      if (const auto* found = std::get_if<PlacedReturn>(&placed)) readings.back().push_back(*found);
    }
  }
  return readings;
}

void mapWholeMission(benchmark::State& state, Carving carving) {
  if (missionFolder().empty()) return state.SkipWithError("the recordings are not there");
  std::size_t points = 0;
  double sensor_seconds = 0.0;
  for (auto _ : state) {
    OpenedMission opened = openMission(missionFolder());
    ThermalMap map({.resolution = kResolution});
    const MissionReport report =
        mapMission({opened.mission, *opened.readings, opened.frames.get()}, map, {.carving = carving});
    points += report.points;
    sensor_seconds += toSeconds(*report.last_stamp - *report.first_stamp);
    benchmark::DoNotOptimize(map.blockCount());
  }
  state.counters["points/s"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
  state.counters["x sensor time"] = benchmark::Counter(sensor_seconds, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(mapWholeMission, octomap_carving, Carving::octomap)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mapWholeMission, no_carving, Carving::none)->Unit(benchmark::kMillisecond);

void insertMissionIntoOctomap(benchmark::State& state) {
  if (missionFolder().empty()) return state.SkipWithError("the recordings are not there");
  const auto readings = placedReadings(kPeerReadings);
  std::size_t points = 0;
  for (auto _ : state) {
    octomap::OcTree tree(kResolution);
    for (const auto& reading : readings) {
      octomap::Pointcloud cloud;
      for (const PlacedReturn& p : reading)
        cloud.push_back(p.p_world.cast<float>().x(), p.p_world.cast<float>().y(),
                        p.p_world.cast<float>().z());
      const Eigen::Vector3f origin = reading.front().origin_world.cast<float>();
      tree.insertPointCloud(cloud, {origin.x(), origin.y(), origin.z()});
      points += reading.size();
    }
    benchmark::DoNotOptimize(tree.size());
  }
  state.counters["points/s"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
}
BENCHMARK(insertMissionIntoOctomap)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace thermovox
