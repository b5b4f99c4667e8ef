#include "tests/benchmark/workloads.hpp"

#include "tests/benchmark/hall_workload.hpp"
#include "tests/support/recorded_scan.hpp"

namespace thermovox::bench {
namespace {

const std::vector<MappedReturn>& recordedReturns() {
  static const std::vector<MappedReturn> returns = [] {
    std::vector<MappedReturn> scan = test::recordedScan();
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const auto range = static_cast<float>((scan[i].p_world - scan[i].origin_world).norm());
      scan[i].temperature = TemperatureObservation{20.0F + static_cast<float>(i % 7), 0.15F, range, 0.3F};
    }
    return scan;
  }();
  return returns;
}

}  // namespace

Workload coldHall(double resolution, int scans) {
  constexpr int every = HallWorkload::kScans / 8;
  return {resolution, scans, [](int index) { return hallWorkload().scan(every * index); }};
}

Workload warmHall(double resolution, int scans) {
  return {resolution, scans, [](int index) { return hallWorkload().scan(index); }};
}

Workload recordedBuilding(double resolution) {
  if (!test::recordings()) return {resolution, 0, {}};
  return {resolution, 1, [](int) { return recordedReturns(); }};
}

}  // namespace thermovox::bench
