// Inserting scans, with all their free space and without it: the thermal map, temperatures and all, against
// its peers in the same run. The time of a row is processor time of all threads together; of several
// iterations the median counts. Rows of the table of mapping/README.md (run.sh) are these.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>

#include "tests/benchmark/workloads.hpp"

namespace thermovox::bench {
namespace {

/// One row: an engine and what it inserts.
struct Row {
  std::string workload;
  std::string engine;
  Workload (*make_workload)();
  std::function<EnginePointer(double resolution)> make_engine;
  int iterations = 1;
};

/// What the rows measured so far in this run cost, by workload and engine.
std::map<std::pair<std::string, std::string>, Measurement>& measured() {
  static std::map<std::pair<std::string, std::string>, Measurement> measured;
  return measured;
}

/// How many times faster than a peer that was measured before, where there is one: in processor time (of two
/// threads that of the busier one) and on the clock on the wall.
void compare(benchmark::State& state, const Row& row, const Measurement& m, const std::string& peer) {
  const auto found = measured().find({row.workload, peer});
  if (found == measured().end() || row.engine == peer) return;
  state.counters["times_" + peer] = found->second.busier_half_s / m.busier_half_s;
  state.counters["wall_times_" + peer] = found->second.wall_s / m.wall_s;
}

void report(benchmark::State& state, const Row& row, const Measurement& m) {
  measured()[{row.workload, row.engine}] = m;
  state.counters["points_per_cpu_s"] = m.points / m.cpu_s;
  state.counters["points_per_s"] = m.points / m.wall_s;
  state.counters["points_per_busier_thread_s"] = m.points / m.busier_half_s;
  state.counters["known_cells"] = m.cells.known;
  state.counters["surface_cells"] = m.cells.surface;
  state.counters["MB"] = 1e-6 * m.memory_bytes;
  state.counters["peak_MB"] = 1e-6 * m.peak_bytes;
  state.counters["bytes_per_known_cell"] = m.memory_bytes / m.cells.known;
  state.counters["bytes_per_known_cell_without_64_a_surface"] =
      (m.memory_bytes - 64.0 * m.cells.surface) / m.cells.known;
  state.counters["bytes_per_surface_cell"] = m.memory_bytes / m.cells.surface;
  for (const char* peer : {"octomap", "openvdb", "block_floor"}) compare(state, row, m, peer);
}

void insert(benchmark::State& state, const Row& row) {
  const Workload workload = row.make_workload();
  if (workload.scans == 0) return state.SkipWithError("the recordings are not there");
  static_cast<void>(workload.scan(0));  // makes it, once for all rows
  std::vector<Measurement> runs;
  for (auto _ : state) {
    runs.push_back(measureInChild([&] { return row.make_engine(workload.resolution); }, workload));
    state.SetIterationTime(runs.back().cpu_s);
  }
  const auto median = runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2);
  std::nth_element(runs.begin(), median, runs.end(),
                   [](const Measurement& a, const Measurement& b) { return a.cpu_s < b.cpu_s; });
  report(state, row, *median);
}

/// The thermal map in every way of carving that frees cells.
std::vector<Row> ourRows(const std::string& workload, Workload (*make_workload)()) {
  const auto with = [](Carving carving, int threads) {
    return [carving, threads](double resolution) { return thermalMapEngine(resolution, carving, threads); };
  };
  return {{workload, "thermovox", make_workload, with(Carving::octomap, 1), 3},
          {workload, "thermovox_2_threads", make_workload, with(Carving::octomap, 2), 3},
          {workload, "thermovox_careful", make_workload, with(Carving::careful, 1), 3}};
}

struct NamedWorkload {
  std::string name;
  Workload (*make)();
  bool slow = false;  ///< slow peers are measured once
};

/// All cells between the laser and its returns are freed.
std::vector<Row> carvingRows() {
  const std::vector<NamedWorkload> workloads = {
      {"carving/hall_0.1_m", [] { return coldHall(0.1, 8); }},
      {"carving/hall_0.05_m", [] { return coldHall(0.05, 4); }},
      {"carving/recorded_scan_0.1_m", [] { return recordedBuilding(0.1); }}};
  std::vector<Row> rows;
  for (const auto& [name, make, slow] : workloads) {
    rows.push_back({name, "octomap", make, octomapRays});
#ifdef THERMOVOX_OPENVDB
    rows.push_back({name, "openvdb", make, openvdbRays, 3});
#endif
    for (Row& row : ourRows(name, make)) rows.push_back(std::move(row));
  }
  return rows;
}

/// Only the cells that hold a return.
std::vector<Row> surfaceRows() {
  const std::vector<NamedWorkload> workloads = {
      {"surfaces/cold_hall_0.1_m", [] { return coldHall(0.1, 8); }},
      {"surfaces/warm_hall_0.1_m", [] { return warmHall(0.1, 200); }, true},
      {"surfaces/cold_hall_0.05_m", [] { return coldHall(0.05, 8); }},
      {"surfaces/warm_hall_0.05_m", [] { return warmHall(0.05, 200); }, true}};
  std::vector<Row> rows;
  for (const auto& [name, make, slow] : workloads) {
    const int once_or_thrice = slow ? 1 : 3;
    rows.push_back({name, "octomap", make, octomapPoints, once_or_thrice});
    rows.push_back({name, "color_octomap", make, colorOctomapPoints, once_or_thrice});
#ifdef THERMOVOX_OPENVDB
    rows.push_back({name, "openvdb", make, openvdbPoints, 3});
#endif
    rows.push_back({name, "block_floor", make, blockFloor, 3});
    const auto ours = [](double resolution) { return thermalMapEngine(resolution, Carving::none); };
    rows.push_back({name, "thermovox", make, ours, 3});
  }
  return rows;
}

[[maybe_unused]] const bool registered = [] {
  for (const auto& rows : {carvingRows(), surfaceRows()}) {
    for (const Row& row : rows) {
      benchmark::RegisterBenchmark((row.workload + "/" + row.engine).c_str(),
                                   [row](benchmark::State& state) { insert(state, row); })
          ->UseManualTime()
          ->Iterations(row.iterations)
          ->Unit(benchmark::kMillisecond);
    }
  }
  return true;
}();

}  // namespace
}  // namespace thermovox::bench
