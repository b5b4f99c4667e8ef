// What the hall workload is like, for whoever compares with figures of elsewhere.

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <unordered_set>

#include "tests/benchmark/hall_workload.hpp"

namespace thermovox::bench {
namespace {

struct CellHash {
  std::size_t operator()(const CellKey& key) const { return BlockKeyHash()({key.x, key.y, key.z}); }
};

/// Counts returns, the cells that a ray passes, and the returns that are the first in their cell.
void describeHall(benchmark::State& state, double resolution, int every) {
  double returns = 0.0, steps = 0.0;
  std::unordered_set<CellKey, CellHash> hit;
  for (auto _ : state) {
    for (int i = 0; i < HallWorkload::kScans; i += every) {
      for (const MappedReturn& ret : hallWorkload().scan(i)) {
        const CellKey from = cellKey(ret.origin_world, 1.0 / resolution);
        const CellKey to = cellKey(ret.p_world, 1.0 / resolution);
        returns += 1.0;
        steps += std::abs(to.x - from.x) + std::abs(to.y - from.y) + std::abs(to.z - from.z);
        hit.insert(to);
      }
    }
  }
  state.counters["returns"] = returns;
  state.counters["steps_a_ray"] = steps / returns;
  state.counters["hit_cells"] = static_cast<double>(hit.size());
  state.counters["first_in_their_cell"] = static_cast<double>(hit.size()) / returns;
}

BENCHMARK_CAPTURE(describeHall, cold_0_1_m, 0.1, 25)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(describeHall, cold_0_05_m, 0.05, 25)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(describeHall, warm_0_1_m, 0.1, 1)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thermovox::bench
