// Saving and loading a station: bytes of the map in memory (log-odds, masks, surfaces) a second on the clock
// on the wall, with a warm page cache. Beside it, in the same run, the same bytes through plain write() and
// read(), brought to the disk as the station is, and the same map through OctoMap's .ot.

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <octomap/ColorOcTree.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "io/octomap_file.hpp"
#include "io/palette.hpp"
#include "io/station.hpp"
#include "tests/benchmark/hall_workload.hpp"

namespace thermovox::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kScans = 25;

/// The hall at 0.05 m, every eighth scan of the flight.
const ThermalMap& hall() {
  static const ThermalMap map = [] {
    ThermalMap made({.resolution = 0.05});
    for (int i = 0; i < kScans; ++i) made.integrate(hallWorkload().scan(8 * i), Carving::octomap);
    return made;
  }();
  return map;
}

double bytesOf(const ThermalMap& map) {
  constexpr std::size_t block_bytes = kBlockCells + sizeof(CellBits);
  return static_cast<double>(map.blockCount() * block_bytes + map.surfaceCount() * sizeof(SurfaceCell));
}

/// A folder that goes with the process.
const fs::path& folder() {
  static const struct Folder {
    fs::path path;
    Folder() {
      std::string name = (fs::temp_directory_path() / "thermovox-XXXXXX").string();
      path = ::mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
  } made;
  return made.path;
}

void count(benchmark::State& state, const fs::path& file) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytesOf(hall())) * state.iterations());
  state.counters["map_MB"] = 1e-6 * bytesOf(hall());
  state.counters["file_MB"] = 1e-6 * static_cast<double>(fs::file_size(file));
}

void saveStation(const fs::path& file, int threads) {
  fs::remove(file);
  Station::create(file, hall().options(), {.threads = threads})
      .addMission({.name = "hall"}, hall(), KnownMission::refuse);
}

void stationSave(benchmark::State& state) {
  const fs::path file = folder() / "hall.tvx";
  (void)hall();
  for (auto _ : state) saveStation(file, static_cast<int>(state.range(0)));
  count(state, file);
}
BENCHMARK(stationSave)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void stationLoad(benchmark::State& state) {
  const fs::path file = folder() / "hall.tvx";
  saveStation(file, 0);
  for (auto _ : state) {
    const ThermalMap map = Station::open(file, {.threads = static_cast<int>(state.range(0))}).loadMap();
    benchmark::DoNotOptimize(map.blockCount());
  }
  count(state, file);
}
BENCHMARK(stationLoad)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void stationContinue(benchmark::State& state) {  // with a mission that touches nothing of it
  const fs::path file = folder() / "continued.tvx";
  for (auto _ : state) {
    state.PauseTiming();
    saveStation(file, 0);
    state.ResumeTiming();
    Station::open(file).addMission({.name = "empty"}, ThermalMap(hall().options()), KnownMission::refuse);
  }
  count(state, file);
}
BENCHMARK(stationContinue)->UseRealTime()->Unit(benchmark::kMillisecond);

void plainWrite(benchmark::State& state) {
  const fs::path file = folder() / "plain";
  const std::vector<char> bytes(static_cast<std::size_t>(bytesOf(hall())), 'x');
  for (auto _ : state) {
    const int descriptor = ::open(file.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t written = ::write(descriptor, bytes.data() + done, bytes.size() - done);
      if (written <= 0) return state.SkipWithError("cannot write");
      done += static_cast<std::size_t>(written);
    }
    ::fsync(descriptor);
    ::close(descriptor);
  }
  count(state, file);
}
BENCHMARK(plainWrite)->UseRealTime()->Unit(benchmark::kMillisecond);

void plainRead(benchmark::State& state) {
  const fs::path file = folder() / "plain";
  std::vector<char> bytes(static_cast<std::size_t>(bytesOf(hall())));
  for (auto _ : state) {
    const int descriptor = ::open(file.c_str(), O_RDONLY);
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t read = ::read(descriptor, bytes.data() + done, bytes.size() - done);
      if (read <= 0) return state.SkipWithError("cannot read");
      done += static_cast<std::size_t>(read);
    }
    ::close(descriptor);
  }
  count(state, file);
}
BENCHMARK(plainRead)->UseRealTime()->Unit(benchmark::kMillisecond);

void octomapFileLoad(benchmark::State& state) {
  const fs::path file = folder() / "hall.ot";
  if (!fs::exists(file)) writeOt(file, hall(), {}, Existing::replace);
  for (auto _ : state) {
    const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(file.string()));
    benchmark::DoNotOptimize(tree->size());
  }
  count(state, file);
}
BENCHMARK(octomapFileLoad)->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);

void octomapFileSave(benchmark::State& state) {  // of the tree as it is; making it of a map is not counted
  const fs::path file = folder() / "hall.ot";
  if (!fs::exists(file)) writeOt(file, hall(), {}, Existing::replace);
  const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(file.string()));
  for (auto _ : state) {
    if (!tree->write(file.string())) return state.SkipWithError("cannot write");
    const int descriptor = ::open(file.c_str(), O_RDONLY);
    ::fsync(descriptor);
    ::close(descriptor);
  }
  count(state, file);
}
BENCHMARK(octomapFileSave)->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace thermovox::bench
