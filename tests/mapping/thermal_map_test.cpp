#include "mapping/thermal_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

using test::randomMission;
using test::sameMap;
using testing::HasSubstr;

MappedReturn returnAt(const Eigen::Vector3d& p_world, std::optional<double> celsius = std::nullopt) {
  MappedReturn ret{p_world, Eigen::Vector3d(0.05, 0.05, 0.05), Time{}, std::nullopt};
  if (celsius) ret.temperature = TemperatureObservation{static_cast<float>(*celsius), 0.1F, 1.0F, 0.0F};
  return ret;
}

TEST(ThermalMap, MapsGeometryWithoutTemperature) {
  ThermalMap map({.resolution = 0.1});
  map.integrate(std::vector{returnAt({1.05, 0.05, 0.05})}, Carving::octomap);
  EXPECT_EQ(map.surfaceCount(), 1U);
  EXPECT_EQ(map.surface({10, 0, 0})->observations, 0U);
  EXPECT_EQ(map.occupancy({10, 0, 0}), Occupancy::occupied);
  for (int x = 0; x < 10; ++x) EXPECT_EQ(map.occupancy({x, 0, 0}), Occupancy::free);
  EXPECT_EQ(map.occupancy({11, 0, 0}), Occupancy::unknown);
  EXPECT_FALSE(map.logOdds({11, 0, 0}));
}

TEST(ThermalMap, UpdatesACellOnceAReadingAndPrefersTheHit) {
  ThermalMap map({.resolution = 0.1});
  // The second ray passes the cell that the first one hits.
  map.integrate(
      std::vector{returnAt({1.05, 0.05, 0.05}), returnAt({2.05, 0.05, 0.05}), returnAt({1.06, 0.05, 0.05})},
      Carving::octomap);
  EXPECT_NEAR(*map.logOdds({10, 0, 0}), std::log(0.7 / 0.3), 1e-9);
  EXPECT_EQ(map.surface({10, 0, 0})->returns, 2U);
  EXPECT_NEAR(*map.logOdds({5, 0, 0}), std::log(0.4 / 0.6), 1e-3);
}

TEST(ThermalMap, FreesNothingWithoutCarving) {
  ThermalMap map({.resolution = 0.1});
  map.integrate(std::vector{returnAt({1.05, 0.05, 0.05})}, Carving::none);
  EXPECT_EQ(map.occupancy({5, 0, 0}), Occupancy::unknown);
  EXPECT_EQ(map.occupancy({10, 0, 0}), Occupancy::occupied);
}

TEST(ThermalMap, KeepsTheSurfaceOfACellThatRaysCarvedAway) {
  ThermalMap map({.resolution = 0.1});
  map.integrate(std::vector{returnAt({1.05, 0.05, 0.05}, 80.0)}, Carving::octomap);
  for (int i = 0; i < 10; ++i) map.integrate(std::vector{returnAt({2.05, 0.05, 0.05})}, Carving::octomap);
  EXPECT_EQ(map.occupancy({10, 0, 0}), Occupancy::free);
  ASSERT_NE(map.surface({10, 0, 0}), nullptr);
  EXPECT_NEAR(map.surface({10, 0, 0})->mean(), 80.0, 1e-4);
}

TEST(ThermalMap, TemperatureNeverMovesGeometry) {
  ThermalMap warm({.resolution = 0.1}), plain({.resolution = 0.1});
  warm.integrate(std::vector{returnAt({1.03, 0.31, 0.05}, 500.0)}, Carving::octomap);
  plain.integrate(std::vector{returnAt({1.03, 0.31, 0.05})}, Carving::octomap);
  EXPECT_EQ(warm.surface({10, 3, 0})->offset_sum, plain.surface({10, 3, 0})->offset_sum);
  EXPECT_EQ(warm.block({0, 0, 0})->log_odds, plain.block({0, 0, 0})->log_odds);
}

TEST(ThermalMap, RefusesWhatIsNotFiniteAndStaysAsItWas) {
  ThermalMap map({.resolution = 0.1});
  const double nan = std::nan("");
  std::vector<MappedReturn> bad{returnAt({nan, 0, 0}), returnAt({0, INFINITY, 0}), returnAt({1, 1, 1}, nan),
                                returnAt({1e9, 0, 0})};
  MappedReturn lost = returnAt({1, 1, 1});
  lost.origin_world.z() = nan;
  bad.push_back(lost);
  MappedReturn vague = returnAt({1, 1, 1}, 20.0);
  vague.temperature->sigma = std::nanf("");
  bad.push_back(vague);
  for (const MappedReturn& ret : bad) {
    EXPECT_THROW(map.integrate(std::vector{returnAt({2, 2, 2}), ret}, Carving::octomap), DataError);
  }
  EXPECT_EQ(map.blockCount(), 0U);
  EXPECT_THAT(test::messageOf<DataError>([&] { map.integrate(std::vector{bad[0]}, Carving::none); }),
              HasSubstr("a return at (nan"));
}

TEST(ThermalMap, RefusesResolutionsByName) {
  EXPECT_THAT(test::messageOf<ConfigError>([] { const ThermalMap map({.resolution = 0.0}); }),
              HasSubstr("resolution is 0 m"));
  EXPECT_THROW(const ThermalMap map({.resolution = std::nan("")}), ConfigError);
}

TEST(ThermalMap, DoesNotDependOnTheOrderOfGeometryWithinAReading) {
  std::mt19937 rng(21);
  std::uniform_real_distribution<double> coordinate(-4.0, 4.0);
  std::vector<MappedReturn> reading;
  for (int i = 0; i < 500; ++i)
    reading.push_back(returnAt({coordinate(rng), coordinate(rng), coordinate(rng)}));
  ThermalMap forward({.resolution = 0.1}), shuffled({.resolution = 0.1});
  forward.integrate(reading, Carving::octomap);
  std::shuffle(reading.begin(), reading.end(), rng);
  shuffled.integrate(reading, Carving::octomap);
  EXPECT_TRUE(sameMap(forward, shuffled));
}

TEST(ThermalMap, MergesMissionsInAnyOrderAndGroupingBitForBit) {
  const ThermalMap a = randomMission(1), b = randomMission(2), c = randomMission(3);
  ThermalMap left(a.options()), right(a.options()), grouped(a.options());
  left.merge(a);
  left.merge(b);
  left.merge(c);
  grouped.merge(c);
  grouped.merge(b);  // c + b first, then a
  right.merge(a);
  right.merge(grouped);
  EXPECT_TRUE(sameMap(left, right));
  EXPECT_FALSE(sameMap(left, a));
}

TEST(ThermalMap, AddsLogOddsOverMissionsAndClampsOnReading) {
  ThermalMap mission({.resolution = 0.1});
  for (int i = 0; i < 10; ++i) mission.integrate(std::vector{returnAt({1.05, 0.05, 0.05})}, Carving::octomap);
  ThermalMap station(mission.options());
  station.merge(mission);
  station.merge(mission);
  EXPECT_EQ(station.block({1, 0, 0})->log_odds[2], 2 * mission.block({1, 0, 0})->log_odds[2]);
  EXPECT_EQ(station.logOdds({10, 0, 0}), mission.logOdds({10, 0, 0}));
}

TEST(ThermalMap, RefusesToMergeOtherCells) {
  ThermalMap map({.resolution = 0.1});
  EXPECT_THROW(map.merge(ThermalMap({.resolution = 0.05})), ConfigError);
  EXPECT_THROW(map.merge(ThermalMap({.resolution = 0.1, .occupancy = {.prob_hit = 0.8}})), ConfigError);
}

TEST(ThermalMap, VisitsSurfacesInTheOrderOfTheirTiles) {
  const ThermalMap map = randomMission(4);
  std::vector<std::pair<TileKey, std::uint32_t>> order;
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    order.emplace_back(placeOf(key).tile, placeOf(key).in_tile);
    EXPECT_EQ(map.surface(key), &cell);
  });
  EXPECT_EQ(order.size(), map.surfaceCount());
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

}  // namespace
}  // namespace thermovox
