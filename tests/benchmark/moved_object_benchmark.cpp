// What each way of carving keeps and what it leaves behind: a box stands in the hall while the first 40 scans
// fly past and is then taken away; the same mission goes on for 40 scans, and two more missions follow. True
// cells are those that the hall without the box gives a return, false ones those that only the box did.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <set>

#include "tests/benchmark/hall_workload.hpp"

namespace thermovox::bench {
namespace {

constexpr double kResolution = 0.1;  // metres
constexpr int kFirstScan = 60, kTakenAway = 100, kLastScan = 140;

/// A box of 1 x 1 x 2 m, 3 m from the place of a scan.
struct Box {
  Eigen::Vector3d low, high;

  /// The return moves to where its ray meets the box, if it does; tells whether.
  bool catches(MappedReturn& ret) const {
    const Eigen::Vector3d way = ret.p_world - ret.origin_world;
    const Eigen::Vector3d a = (low - ret.origin_world).cwiseQuotient(way);
    const Eigen::Vector3d b = (high - ret.origin_world).cwiseQuotient(way);
    const double enters = a.cwiseMin(b).maxCoeff(), leaves = a.cwiseMax(b).minCoeff();
    if (!(enters > 0.0 && enters < std::min(leaves, 1.0))) return false;
    ret.p_world = ret.origin_world + enters * way;
    return true;
  }
};

Box boxBesideTheFlight() {
  const Eigen::Vector3d place = hallWorkload().scan(kTakenAway).front().origin_world;
  const Eigen::Vector3d center(place.x() + 3.0, place.y(), 1.0);
  return {center - Eigen::Vector3d(0.5, 0.5, 1.0), center + Eigen::Vector3d(0.5, 0.5, 1.0)};
}

using Cells = std::set<CellKey>;

void fly(ThermalMap& map, int from, int to, Carving carving) {
  for (int i = from; i < to; ++i) map.integrate(hallWorkload().scan(i), carving);
}

/// The flight past the box; gives the cells in which its returns lie.
Cells flyPastTheBox(ThermalMap& map, Carving carving) {
  const Box box = boxBesideTheFlight();
  Cells hit;
  for (int i = kFirstScan; i < kTakenAway; ++i) {
    std::vector<MappedReturn> scan = hallWorkload().scan(i);
    for (MappedReturn& ret : scan) {
      if (box.catches(ret)) hit.insert(map.keyOf(ret.p_world));
    }
    map.integrate(scan, carving);
  }
  return hit;
}

double occupied(const ThermalMap& map, const Cells& cells) {
  return static_cast<double>(std::count_if(cells.begin(), cells.end(), [&map](const CellKey& key) {
    return map.occupancy(key) == Occupancy::occupied;
  }));
}

void movedObject(benchmark::State& state, Carving carving) {
  for (auto _ : state) {
    ThermalMap hall({.resolution = kResolution});
    fly(hall, kFirstScan, kLastScan, Carving::none);
    ThermalMap mission({.resolution = kResolution});
    Cells box;
    for (const CellKey& key : flyPastTheBox(mission, carving)) {
      if (hall.surface(key) == nullptr) box.insert(key);
    }
    fly(mission, kTakenAway, kLastScan, carving);
    Cells surface;
    forEachSurface(mission, [&](const CellKey& key, const SurfaceCell&) {
      if (!box.contains(key)) surface.insert(key);
    });
    state.counters["true_cells"] = static_cast<double>(surface.size());
    state.counters["true_cells_kept"] = occupied(mission, surface);
    state.counters["false_cells"] = static_cast<double>(box.size());
    state.counters["false_cells_left"] = occupied(mission, box);
    for (const char* counter : {"false_cells_left_after_the_next", "false_cells_left_after_two"}) {
      ThermalMap next({.resolution = kResolution});
      fly(next, kFirstScan, kLastScan, carving);
      mission.merge(next);
      state.counters[counter] = occupied(mission, box);
    }
  }
}

BENCHMARK_CAPTURE(movedObject, none, Carving::none)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(movedObject, octomap, Carving::octomap)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(movedObject, careful, Carving::careful)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thermovox::bench
