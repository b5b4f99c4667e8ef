// Inserting readings with all their free space: the thermal map, temperatures and all, against OctoMap's
// insertPointCloud in the same run. Rates are points per second of processor time.

#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "mapping/thermal_map.hpp"
#include "tests/support/recorded_scan.hpp"

namespace thermovox {
namespace {

using Readings = std::vector<std::vector<MappedReturn>>;

const Eigen::Vector3d kHalfSize(30.0, 15.0, 6.0);  // metres
constexpr double kRackSpacing = 8.0, kRackHalfWidth = 0.6, kRackTop = 2.0;

/// Distance along the ray to the slab -half..half of one axis about `center`: where it enters and leaves.
std::pair<double, double> slab(double origin, double direction, double center, double half) {
  const double a = (center - half - origin) / direction, b = (center + half - origin) / direction;
  return {std::min(a, b), std::max(a, b)};
}

/// Distance to the hall's walls, or to one of its four rows of racks along x.
double rangeInHall(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double range = 1e9;
  for (int i = 0; i < 3; ++i)
    range = std::min(range, slab(origin[i], direction[i], 0.0, kHalfSize[i]).second);
  for (double y = -1.5 * kRackSpacing; y < kHalfSize.y(); y += kRackSpacing) {
    const auto [x_in, x_out] = slab(origin.x(), direction.x(), 0.0, 25.0);
    const auto [y_in, y_out] = slab(origin.y(), direction.y(), y, kRackHalfWidth);
    const auto [z_in, z_out] = slab(origin.z(), direction.z(), -kHalfSize.z(), kRackTop + kHalfSize.z());
    const double in = std::max({x_in, y_in, z_in});
    if (in > 0.0 && in < std::min({x_out, y_out, z_out})) range = std::min(range, in);
  }
  return range;
}

/// Sweeps of 64 x 1024 beams within +-45 degrees of the horizon along the hall, every point with a
/// temperature.
Readings hallSweeps(int sweeps) {
  Readings readings;
  for (int s = 0; s < sweeps; ++s) {
    const Eigen::Vector3d origin(-25.0 + 50.0 * s / sweeps, 0.3 + 0.1 * s, -1.0);
    std::vector<MappedReturn> reading;
    for (int ring = 0; ring < 64; ++ring) {
      for (int column = 0; column < 1024; ++column) {
        const double azimuth = (column + 0.37) * 2.0 * std::numbers::pi / 1024;
        const double elevation = (ring - 31.5) / 64 * std::numbers::pi / 2;
        const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                        std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const double range = rangeInHall(origin, direction);
        const TemperatureObservation seen{static_cast<float>(20.0 + column % 7), 0.1F,
                                          static_cast<float>(range), 0.3F};
        reading.push_back({origin + range * direction, origin, Time(std::chrono::seconds(s)), seen});
      }
    }
    readings.push_back(std::move(reading));
  }
  return readings;
}

const Readings& hall() {
  static const Readings readings = hallSweeps(4);
  return readings;
}

/// One recorded sweep, empty where the recordings are not there.
const Readings& recorded() {
  static const Readings readings = [] {
    const std::vector<MappedReturn> scan =
        test::recordings() ? test::recordedScan() : std::vector<MappedReturn>{};
    return Readings{scan};
  }();
  return readings;
}

octomap::point3d octomapPoint(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

void insertIntoThermalMap(benchmark::State& state, const Readings& readings, double resolution,
                          Carving carving) {
  std::size_t points = 0;
  for (auto _ : state) {
    ThermalMap map({.resolution = resolution});
    for (const auto& reading : readings) {
      map.integrate(reading, carving);
      points += reading.size();
    }
    benchmark::DoNotOptimize(map.blockCount());
  }
  state.counters["points/s"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
}

void insertIntoOctomap(benchmark::State& state, const Readings& readings, double resolution) {
  std::size_t points = 0;
  for (auto _ : state) {
    octomap::OcTree tree(resolution);
    for (const auto& reading : readings) {
      octomap::Pointcloud cloud;
      for (const MappedReturn& ret : reading) cloud.push_back(octomapPoint(ret.p_world));
      if (!reading.empty()) tree.insertPointCloud(cloud, octomapPoint(reading[0].origin_world));
      points += reading.size();
    }
    benchmark::DoNotOptimize(tree.size());
  }
  state.counters["points/s"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
}

#define THERMOVOX_INSERTION(name, readings, resolution)                                   \
  BENCHMARK_CAPTURE(insertIntoThermalMap, name, readings(), resolution, Carving::octomap) \
      ->Unit(benchmark::kMillisecond);                                                    \
  BENCHMARK_CAPTURE(insertIntoOctomap, name, readings(), resolution)->Unit(benchmark::kMillisecond)

THERMOVOX_INSERTION(hall_0_1_m, hall, 0.1);
THERMOVOX_INSERTION(recorded_scan_0_1_m, recorded, 0.1);
BENCHMARK_CAPTURE(insertIntoThermalMap, hall_0_1_m_hits_only, hall(), 0.1, Carving::none)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thermovox
