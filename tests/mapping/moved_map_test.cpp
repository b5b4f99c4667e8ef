#include "mapping/moved_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "projection/error.hpp"
#include "tests/support/memory_store.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

using test::randomMission;

ThermalMap movedMap(const ThermalMap& map, const Pose& T_world_map) {
  ThermalMap result(map.options());
  addMoved(map, T_world_map, result);
  return result;
}

TEST(MovedMap, WithoutAMotionHasTheSameCells) {
  const ThermalMap map = randomMission(1);
  const ThermalMap moved = movedMap(map, {});
  EXPECT_EQ(moved.surfaceCount(), map.surfaceCount());
  map.forEachBlock([&](const BlockKey& key, const Block& block) {
    ASSERT_NE(moved.block(key), nullptr);
    EXPECT_TRUE(moved.block(key)->log_odds == block.log_odds);
  });
}

TEST(MovedMap, ByWholeCellsKeepsEveryCell) {
  const ThermalMap map = randomMission(1);
  const ThermalMap moved = movedMap(map, {Eigen::Quaterniond::Identity(), {1.3, -0.7, 2.0}});
  EXPECT_EQ(moved.surfaceCount(), map.surfaceCount());
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    const CellKey there{key.x + 13, key.y - 7, key.z + 20};
    const SurfaceCell* found = moved.surface(there);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(+found->returns, +cell.returns);
    EXPECT_EQ(+found->weighted_sum, +cell.weighted_sum);
    EXPECT_LT((found->meanOffset() - cell.meanOffset()).norm(), 0.01);
    EXPECT_EQ(moved.logOdds(there), map.logOdds(key));
  });
}

TEST(MovedMap, KeepsStatisticsAndPlacesThroughARotation) {
  const ThermalMap map = randomMission(2);
  const Pose T{Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())), {4, 5, 6}};
  const ThermalMap moved = movedMap(map, T);
  std::uint64_t before = 0, after = 0, weights_before = 0, weights_after = 0;
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    before += cell.returns;
    weights_before += cell.weight_sum;
    const Eigen::Vector3d p = (Eigen::Vector3d(key.x, key.y, key.z) + cell.meanOffset()) * map.resolution();
    EXPECT_NE(moved.surface(moved.keyOf(T * p)), nullptr);
  });
  forEachSurface(moved, [&](const CellKey&, const SurfaceCell& cell) {
    EXPECT_TRUE(cell.isPlausible());
    after += cell.returns;
    weights_after += cell.weight_sum;
  });
  EXPECT_EQ(after, before);
  EXPECT_EQ(weights_after, weights_before);
}

TEST(MovedMap, TakesLogOddsFromWhereTheCellsCentreWas) {
  const ThermalMap map = randomMission(3);
  const Pose T{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())), {0.21, 0.4, -0.3}};
  const ThermalMap moved = movedMap(map, T);
  int known = 0;
  moved.forEachBlock([&](const BlockKey& key, const Block&) {
    for (int i = 0; i < kBlockCells; ++i) {
      const CellKey cell = cellAt(key, i);
      EXPECT_EQ(moved.logOdds(cell), map.logOdds(map.keyOf(T.inverse() * moved.centerOf(cell))));
      known += moved.logOdds(cell).has_value();
    }
  });
  EXPECT_GT(known, 1000);
}

TEST(MovedMap, IsTheSameWhereTilesWaitInAStore) {
  const Pose T{Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())), {4, 5, 6}};
  const ThermalMap map = randomMission(2, 0.03);
  const ThermalMap expected = movedMap(map, T);
  constexpr std::size_t limit = 300'000;
  test::MemoryStore from_store, to_store;
  ThermalMap from = randomMission(2, 0.03), to(map.options());
  from.spillTo(from_store, limit);
  to.spillTo(to_store, limit);
  addMoved(from, T, to);
  EXPECT_GT(expected.memoryBytes(), 5 * limit);
  EXPECT_GT(from.spilledTiles(), 5U);
  EXPECT_GT(to.spilledTiles(), 5U);
  EXPECT_LE(from.memoryBytes(), 2 * limit);
  EXPECT_LE(to.memoryBytes(), 2 * limit);
  EXPECT_TRUE(test::sameMap(to, expected));
}

TEST(MovedMap, AddsToWhatIsThere) {
  const Pose by_cells{Eigen::Quaterniond::Identity(), {1.3, -0.7, 2.0}};
  ThermalMap expected = movedMap(randomMission(1), by_cells);
  expected.merge(randomMission(2));
  ThermalMap together = randomMission(2);
  addMoved(randomMission(1), by_cells, together);
  EXPECT_TRUE(test::sameMap(together, expected));
  ThermalMap coarse({.resolution = 0.2});
  EXPECT_THROW(addMoved(randomMission(1), by_cells, coarse), ConfigError);
}

TEST(MovedMap, RefusesToLeaveTheWorld) {
  const Pose far{Eigen::Quaterniond::Identity(), {1e7, 0, 0}};
  EXPECT_THROW((void)movedMap(randomMission(1), far), DataError);
}

}  // namespace
}  // namespace thermovox
