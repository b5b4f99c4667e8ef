#pragma once

#include <random>
#include <vector>

#include "mapping/thermal_map.hpp"

namespace thermovox::test {

/// Whether two maps are the same bit for bit, whatever way they came about.
[[nodiscard]] inline bool sameMap(const ThermalMap& a, const ThermalMap& b) {
  if (a.options() != b.options() || a.sortedBlockKeys() != b.sortedBlockKeys()) return false;
  for (const BlockKey& key : a.sortedBlockKeys()) {
    if (!(*a.block(key) == *b.block(key))) return false;
  }
  return true;
}

/// A small map of a few readings of a noisy room, some returns with temperature; another for another seed.
[[nodiscard]] inline ThermalMap randomMission(unsigned seed, double resolution = 0.1) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0), celsius(10.0, 90.0);
  ThermalMap map({.resolution = resolution});
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d origin(0.1 * i, 0.05, 0.5);
    std::vector<MappedReturn> reading;
    for (int j = 0; j < 200; ++j) {
      const Time stamp(std::chrono::seconds(1000 * seed + 10 * i) + std::chrono::milliseconds(j));
      MappedReturn ret{
          {coordinate(rng), coordinate(rng), coordinate(rng) > 0 ? 1.0 : -1.0}, origin, stamp, {}};
      if (j % 3 != 0) {
        const auto range = static_cast<float>((ret.p_world - origin).norm());
        ret.temperature = TemperatureObservation{static_cast<float>(celsius(rng)), 0.2F, range, 0.3F};
      }
      reading.push_back(ret);
    }
    map.integrate(reading, Carving::octomap);
  }
  return map;
}

}  // namespace thermovox::test
