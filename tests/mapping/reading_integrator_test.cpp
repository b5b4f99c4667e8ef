// What a map makes of readings with several threads and with the ways of carving. That the cells are
// OctoMap's is in octomap_parity_test.
#include "mapping/reading_integrator.hpp"

#include <gtest/gtest.h>

#include <random>

#include "mapping/thermal_map.hpp"
#include "projection/error.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

/// Sweeps of a room of 8 x 6 x 3 m with noise, from places along it.
std::vector<std::vector<MappedReturn>> roomSweeps() {
  std::mt19937 rng(4);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<std::vector<MappedReturn>> sweeps(6);
  for (std::size_t s = 0; s < sweeps.size(); ++s) {
    const Eigen::Vector3d origin(-2.0 + 0.7 * static_cast<double>(s), 0.3, 0.2);
    for (int i = 0; i < 9000; ++i) {
      const Eigen::Vector3d direction = Eigen::Vector3d(unit(rng), unit(rng), unit(rng)).normalized();
      double range = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        const double half = std::array{4.0, 3.0, 1.5}[static_cast<std::size_t>(axis)];
        range = std::min(range, (std::copysign(half, direction[axis]) - origin[axis]) / direction[axis]);
      }
      MappedReturn ret{origin + (range + noise(rng)) * direction, origin, Time(std::chrono::seconds(s)), {}};
      ret.temperature = TemperatureObservation{static_cast<float>(20.0 + 10.0 * noise(rng)), 0.1F,
                                               static_cast<float>(range), 0.3F};
      sweeps[s].push_back(ret);
    }
  }
  return sweeps;
}

ThermalMap mapOf(const std::vector<std::vector<MappedReturn>>& sweeps, Carving carving, int threads) {
  ThermalMap map({.resolution = 0.1});
  map.setThreads(threads);
  for (const auto& sweep : sweeps) map.integrate(sweep, carving);
  return map;
}

TEST(Integrate, GivesTheSameMapWithAnyNumberOfThreads) {
  const auto sweeps = roomSweeps();
  for (const Carving carving : {Carving::none, Carving::octomap, Carving::careful}) {
    const ThermalMap one = mapOf(sweeps, carving, 1);
    for (const int threads : {2, 3, 8}) {
      EXPECT_TRUE(test::sameMap(one, mapOf(sweeps, carving, threads))) << threads << " threads";
    }
  }
}

std::size_t occupiedSurfaces(const ThermalMap& map) {
  std::size_t occupied = 0;
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell&) {
    occupied += map.occupancy(key) == Occupancy::occupied;
  });
  return occupied;
}

TEST(CarefulCarving, KeepsEverySurfaceThatOctomapsRuleErases) {
  const auto sweeps = roomSweeps();
  const ThermalMap octomap = mapOf(sweeps, Carving::octomap, 1);
  const ThermalMap careful = mapOf(sweeps, Carving::careful, 1);
  EXPECT_EQ(careful.surfaceCount(), octomap.surfaceCount());
  EXPECT_EQ(occupiedSurfaces(careful), careful.surfaceCount());
  EXPECT_LT(occupiedSurfaces(octomap), octomap.surfaceCount());
}

TEST(CarefulCarving, MakesNoTilesOfWhatIsOnlyBesideAHit) {
  ThermalMap map({.resolution = 0.1});
  const std::vector<MappedReturn> corner{{{0.05, 0.05, 0.05}, {1.05, 1.05, 1.05}, Time(), {}}};
  for (int i = 0; i < 2; ++i) map.integrate(corner, Carving::careful);
  EXPECT_EQ(map.sortedTileKeys(), std::vector<TileKey>{TileKey{}});
  // The marks beside it are gone, too: a ray through that tile frees all its cells.
  const Eigen::Vector3d origin(-0.05, 1.05, 0.05), end(-0.05, -1.05, 0.05);
  map.integrate({{MappedReturn{end, origin, Time(), {}}}}, Carving::careful);
  EXPECT_EQ(map.occupancy(map.keyOf({-0.05, 0.05, 0.05})), Occupancy::free);
}

TEST(CarefulCarving, FreesTheSpaceThatRaysPass) {
  ThermalMap map({.resolution = 0.1});
  const Eigen::Vector3d origin(0.05, 0.05, 0.05);
  map.integrate({{MappedReturn{{2.05, 0.05, 0.05}, origin, Time(), {}}}}, Carving::careful);
  EXPECT_EQ(map.occupancy(map.keyOf({1.05, 0.05, 0.05})), Occupancy::free);
  EXPECT_EQ(map.occupancy(map.keyOf({1.95, 0.05, 0.05})), Occupancy::unknown);  // beside the hit
  EXPECT_EQ(map.occupancy(map.keyOf({2.05, 0.05, 0.05})), Occupancy::occupied);
}

TEST(CarefulCarving, LetsTheNextMissionsFreeWhatMovedAway) {
  const Eigen::Vector3d origin(0.05, 0.05, 0.05);
  const std::vector<MappedReturn> object{{{1.05, 0.05, 0.05}, origin, Time(), {}}};
  const std::vector<MappedReturn> wall{{{2.05, 0.05, 0.05}, origin, Time(), {}}};
  ThermalMap station({.resolution = 0.1});
  ThermalMap first({.resolution = 0.1});
  first.integrate(object, Carving::careful);
  for (int i = 0; i < 10; ++i) first.integrate(wall, Carving::careful);  // in one mission it stays
  const CellKey place = first.keyOf(object.front().p_world);
  EXPECT_EQ(first.occupancy(place), Occupancy::occupied);
  ThermalMap second({.resolution = 0.1});
  for (int i = 0; i < 10; ++i) second.integrate(wall, Carving::careful);
  station.merge(first);
  station.merge(second);
  EXPECT_EQ(station.occupancy(place), Occupancy::free);
}

TEST(Integrate, RefusesAMapOfSeveralMissions) {
  const auto sweeps = roomSweeps();
  ThermalMap map = mapOf(sweeps, Carving::octomap, 1);
  const ThermalMap same = mapOf(sweeps, Carving::octomap, 1);
  for (int i = 0; i < 3; ++i) map.merge(same);
  EXPECT_THROW(map.integrate(sweeps.front(), Carving::octomap), ConfigError);
}

}  // namespace
}  // namespace thermovox
