#include "mapping/imported_geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "projection/error.hpp"
#include "tests/support/memory_store.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

TEST(ImportedGeometry, HitsEveryCellOnceAndFreesNothing) {
  ThermalMap map({.resolution = 0.1, .occupancy = {}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  addGeometry(
      std::vector<Eigen::Vector3d>{{1.02, 0.05, 0.05}, {1.06, 0.05, 0.05}, {3.0, nan, 0.0}, {-2.05, 0, 0}},
      map);
  EXPECT_EQ(map.surfaceCount(), 2U);
  EXPECT_EQ(map.surface({10, 0, 0})->returns, 2U);
  EXPECT_NEAR(map.surface({10, 0, 0})->meanOffset().x(), 0.4, 0.01);
  EXPECT_EQ(map.surface({10, 0, 0})->observations, 0U);
  EXPECT_NEAR(*map.logOdds({10, 0, 0}), std::log(0.7 / 0.3), 1e-9);
  EXPECT_EQ(map.occupancy({5, 0, 0}), Occupancy::unknown);
}

/// A store that notes the most memory its map took before a tile left.
class WeighingStore final : public test::MemoryStore {
 public:
  const ThermalMap* map = nullptr;
  std::size_t most_bytes = 0;

  void put(const TileKey& tile, std::span<const BlockView> blocks) override {
    most_bytes = std::max(most_bytes, map->memoryBytes());
    MemoryStore::put(tile, blocks);
  }
};

TEST(ImportedGeometry, IsThatOfOneReadingAndStaysNearALimitOfMemory) {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> coordinate(-40.0, 40.0), height(-1.0, 1.0);
  std::vector<Eigen::Vector3d> points;
  std::vector<MappedReturn> reading;
  for (int i = 0; i < 60000; ++i) {
    const Eigen::Vector3d& p = points.emplace_back(coordinate(rng), coordinate(rng), height(rng));
    reading.push_back({p, p, Time{}, std::nullopt});
  }
  ThermalMap at_once({.resolution = 0.1, .occupancy = {}}), limited({.resolution = 0.1, .occupancy = {}});
  at_once.integrate(reading, Carving::none);
  constexpr std::size_t limit = 1'000'000;
  WeighingStore store;
  store.map = &limited;
  limited.setThreads(4);
  limited.spillTo(store, limit);
  addGeometry(points, limited);
  EXPECT_GT(at_once.memoryBytes(), 10 * limit);
  EXPECT_GT(store.most_bytes, 0U);
  EXPECT_LE(store.most_bytes, limit + limit / 2);  // by the tile at work, and the marks of its points
  EXPECT_TRUE(test::sameMap(limited, at_once));
}

TEST(ImportedGeometry, ThatReachesTooFarLeavesTheMapAsItWas) {
  ThermalMap map({.resolution = 0.1, .occupancy = {}});
  EXPECT_THROW(addGeometry(std::vector<Eigen::Vector3d>{{1, 0, 0}, {1e9, 0, 0}}, map), DataError);
  EXPECT_EQ(map.blockCount(), 0U);
}

TEST(ImportedGeometry, OfNoPointIsRefused) {
  ThermalMap map({.resolution = 0.1, .occupancy = {}});
  EXPECT_THROW(addGeometry({}, map), DataError);
  EXPECT_THROW(addGeometry(std::vector<Eigen::Vector3d>{{std::nan(""), 0, 0}}, map), DataError);
  EXPECT_THROW(addGeometry(std::vector<Eigen::Vector3d>{{1e9, 0, 0}}, map), DataError);
}

}  // namespace
}  // namespace thermovox
