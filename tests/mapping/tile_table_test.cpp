#include "mapping/tile_table.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "mapping/thermal_map.hpp"
#include "projection/error.hpp"
#include "tests/support/memory_store.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

using test::MemoryStore;

/// Readings all over a place of many tiles.
std::vector<std::vector<MappedReturn>> scatteredReadings() {
  std::mt19937 rng(8);
  std::uniform_real_distribution<double> coordinate(-40.0, 40.0), celsius(10.0, 90.0);
  std::vector<std::vector<MappedReturn>> readings(40);
  for (auto& reading : readings) {
    const Eigen::Vector3d origin(coordinate(rng), coordinate(rng), 0.5);
    for (int i = 0; i < 50; ++i) {
      const TemperatureObservation seen{static_cast<float>(celsius(rng)), 0.2F, 3.0F, 0.3F};
      reading.push_back({origin + 0.2 * Eigen::Vector3d(coordinate(rng), coordinate(rng), 0.1), origin,
                         Time(std::chrono::seconds(i)), seen});
    }
  }
  return readings;
}

TEST(SpilledMap, IsTheSameAsOneInMemory) {
  ThermalMap in_memory({.resolution = 0.1}), spilled({.resolution = 0.1});
  MemoryStore store;
  constexpr std::size_t limit = 400 << 10;
  spilled.spillTo(store, limit);
  for (const auto& reading : scatteredReadings()) {
    in_memory.integrate(reading, Carving::octomap);
    spilled.integrate(reading, Carving::octomap);
    EXPECT_LE(spilled.memoryBytes(), limit);
  }
  EXPECT_GT(in_memory.memoryBytes(), 10 * limit);
  EXPECT_GT(spilled.spilledTiles(), 10U);
  EXPECT_EQ(spilled.surfaceCount(), in_memory.surfaceCount());
  EXPECT_EQ(spilled.blockCount(), in_memory.blockCount());
  std::vector<CellKey> order[2];
  forEachSurface(in_memory, [&](const CellKey& key, const SurfaceCell&) { order[0].push_back(key); });
  forEachSurface(spilled, [&](const CellKey& key, const SurfaceCell&) { order[1].push_back(key); });
  EXPECT_EQ(order[0], order[1]);
  EXPECT_TRUE(test::sameMap(in_memory, spilled));
}

TEST(SpilledMap, CountsWhatItKeepsForTheNextReading) {
  ThermalMap map({.resolution = 0.1});
  MemoryStore store;
  for (const auto& reading : scatteredReadings()) map.integrate(reading, Carving::octomap);
  const std::size_t whole = map.memoryBytes();
  map.spillTo(store, 2 * whole);
  EXPECT_EQ(map.memoryBytes(), whole);
  const std::size_t spilled = map.spilledTiles();
  map.spillTo(store, whole - 1);  // the tiles alone would fit
  EXPECT_GT(map.spilledTiles(), spilled);
  map.spillTo(store, 0);
  EXPECT_LE(map.memoryBytes(), whole / 10);
}

/// Refuses to give back its first tile once it is told to.
class FailingStore final : public TileStore {
 public:
  bool fails = false;

  void put(const TileKey& tile, std::span<const BlockView> blocks) override { store_.put(tile, blocks); }
  std::optional<TileBlocks> take(const TileKey& tile) override {
    if (std::exchange(fails, false)) throw DataError("the disk is gone");
    return store_.take(tile);
  }
  std::optional<TileBlocks> get(const TileKey& tile) const override { return store_.get(tile); }
  bool holds(const TileKey& tile) const override { return store_.holds(tile); }
  std::vector<TileKey> sortedTiles() const override { return store_.sortedTiles(); }

 private:
  MemoryStore store_;
};

TEST(SpilledMap, ForgetsAReadingThatFailed) {
  const auto readings = scatteredReadings();
  ThermalMap expected({.resolution = 0.1}), map({.resolution = 0.1});
  FailingStore store;
  map.spillTo(store, 100 << 10);
  for (const std::size_t i : {0, 1, 2, 4}) expected.integrate(readings[i], Carving::octomap);
  for (const std::size_t i : {0, 1, 2}) map.integrate(readings[i], Carving::octomap);
  std::vector<MappedReturn> elsewhere = readings[0];  // whose tiles are in the store by now
  store.fails = true;
  EXPECT_THROW(map.integrate(elsewhere, Carving::octomap), DataError);
  map.integrate(readings[4], Carving::octomap);
  EXPECT_TRUE(test::sameMap(expected, map));
}

TEST(SpilledMap, MergesAndObserves) {
  ThermalMap whole({.resolution = 0.1}), spilled({.resolution = 0.1});
  MemoryStore store;
  spilled.spillTo(store, 1 << 20);
  for (const auto& reading : scatteredReadings()) {
    ThermalMap mission({.resolution = 0.1});
    mission.integrate(reading, Carving::careful);
    whole.merge(mission);
    spilled.merge(mission);
    const CellKey seen = whole.keyOf(reading.front().p_world);
    whole.observe(seen, {30.0F, 0.1F, 1.0F, 0.0F}, Time());
    spilled.observe(seen, {30.0F, 0.1F, 1.0F, 0.0F}, Time());
  }
  EXPECT_GT(spilled.spilledTiles(), 10U);
  EXPECT_TRUE(test::sameMap(whole, spilled));
}

}  // namespace
}  // namespace thermovox
