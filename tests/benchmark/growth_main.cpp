// What a map costs as it grows: maps the hall at 0.1 m with all its free space, scan after scan, and writes
// time and memory after each as CSV and as a picture.
//   thermovox_growth CURVE.csv CURVE.png [SCANS]

#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/benchmark/growth.hpp"
#include "tests/benchmark/hall_workload.hpp"
#include "tests/benchmark/measurement.hpp"

namespace thermovox::bench {
namespace {

std::vector<GrowthPoint> growAlong(int scans) {
  keepScansOutOfTheHeap();
  std::vector<MappedReturn> scan = hallWorkload().scan(0);
  malloc_trim(0);
  const double before = residentBytes();
  const EnginePointer map = thermalMapEngine(0.1, Carving::octomap);
  std::vector<GrowthPoint> curve;
  for (int i = 0; i < scans; ++i) {
    scan = {};  // never two of them in memory, which is the map's
    scan = hallWorkload().scan(i);
    Stopwatch watch;
    watch.start();
    map->insert(scan);
    watch.stop();
    const double total = curve.empty() ? 0.0 : curve.back().total_cpu_s;
    curve.push_back({i + 1, 1e3 * watch.cpu(), total + watch.cpu(), 1e-6 * (residentBytes() - before)});
  }
  return curve;
}

int run(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fputs("usage: thermovox_growth CURVE.csv CURVE.png [SCANS]\n", stderr);
    return 2;
  }
  const int scans =
      argc == 4 ? std::clamp(std::atoi(argv[3]), 4, HallWorkload::kScans) : HallWorkload::kScans;
  const std::vector<GrowthPoint> curve = growAlong(scans);
  writeGrowthCsv(argv[1], curve);
  writeGrowthPicture(argv[2], curve);
  const Linearity line = linearity(curve);
  std::printf(
      "%d scans: %.1f ms of processor time each, total never further than %.1f %% from a straight line, the "
      "last quarter %.2f times as dear as the first; %.0f MB\n",
      scans, 1e3 * line.seconds_a_scan, 100.0 * line.worst, line.last_to_first, curve.back().memory_mb);
  return 0;
}

}  // namespace
}  // namespace thermovox::bench

int main(int argc, char** argv) {
  try {
    return thermovox::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "thermovox_growth: %s\n", error.what());
    return 1;
  }
}
