// Two passes and painting with maps whose tiles wait in a store.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include "mapping/imported_geometry.hpp"
#include "mapping/mission_mapper.hpp"
#include "tests/mapping/synthetic_mission.hpp"
#include "tests/support/memory_store.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox::test {
namespace {

using Pass = MissionMapper::Pass;

/// A map that may have a limit of its memory.
struct LimitedMap {
  MemoryStore store;
  ThermalMap map{ThermalMap::Options{}};

  explicit LimitedMap(std::optional<std::size_t> limit_bytes) {
    if (limit_bytes) map.spillTo(store, *limit_bytes);
  }
};

/// 30 m along a row of posts, which stand before a wall that only an imported cloud knows.
std::vector<Reading> sweepsPastPosts() {
  std::mt19937_64 rng(41);
  std::uniform_real_distribution<double> depth(2.0, 6.0), side(-1.5, 1.5), height(-1.0, 1.0);
  std::vector<Reading> readings;
  for (int i = 0; i < 90; ++i) {
    Reading reading{.stamp = at(10.5 + 0.1 * i)};
    for (int post = 0; post < 3; ++post) {
      const double x = depth(rng), y = side(rng);
      for (int j = 0; j < 60; ++j)
        reading.returns.push_back({reading.stamp, {x, y + 0.05 * (j % 6), height(rng)}});
    }
    readings.push_back(std::move(reading));
  }
  return readings;
}

std::vector<Eigen::Vector3d> wallBehind() {
  std::vector<Eigen::Vector3d> points;
  for (int y = -50; y < 700; ++y) {
    for (int z = -20; z < 60; ++z) points.emplace_back(7.52, 0.05 * y + 0.02, 0.05 * z + 0.02);
  }
  return points;
}

std::vector<ThermalFrame> warmingFrames() {
  std::vector<ThermalFrame> frames;
  for (int i = 0; i < 45; ++i) frames.push_back(frameAt(10.5 + kPeriod * i, 20.0 + i));
  return frames;
}

struct Look {
  LimitedMap known, own;
  MissionReport report;
  std::vector<std::optional<float>> celsius;  ///< of every point
  std::size_t most_bytes = 0;                 ///< that either map took after a reading

  /// The mission above in two passes; either map may take so much memory.
  Look(Pass pass, std::optional<std::size_t> limit_bytes) : known(limit_bytes), own(limit_bytes) {
    const Mission mission = missionOf(poses(3.0, 0.0));
    addGeometry(wallBehind(), known.map);
    const auto weigh = [this](Time) {
      most_bytes = std::max({most_bytes, known.map.memoryBytes(), own.map.memoryBytes()});
    };
    Readings first(sweepsPastPosts());
    (void)mapMission({mission, first, nullptr}, own.map, {}, {.points = {}, .progress = weigh});
    SceneSurfaces scene({&known.map, &own.map});
    Readings second(sweepsPastPosts());
    Frames frames(warmingFrames());
    const auto note = [this](std::span<const ColouredReturn> reading) {
      for (const ColouredReturn& point : reading) {
        celsius.push_back(point.colour ? std::optional(static_cast<float>(point.colour->celsius))
                                       : std::nullopt);
      }
    };
    report = mapMission({mission, second, &frames}, own.map, {.pass = pass, .scene = &scene},
                        {.points = note, .progress = weigh});
  }
};

class SpilledSecondLook : public testing::TestWithParam<Pass> {};

TEST_P(SpilledSecondLook, IsTheSameAsInMemoryAndStaysNearTheLimit) {
  constexpr std::size_t limit = 300'000;
  const Look in_memory(GetParam(), std::nullopt);
  const Look spilled(GetParam(), limit);
  EXPECT_GT(in_memory.report.coloured, 5000U);
  EXPECT_EQ(spilled.report.coloured, in_memory.report.coloured);
  EXPECT_EQ(spilled.report.uncoloured, in_memory.report.uncoloured);
  EXPECT_EQ(spilled.report.painted, in_memory.report.painted);
  EXPECT_EQ(in_memory.report.painted > 10000, GetParam() == Pass::paint);
  EXPECT_EQ(spilled.celsius, in_memory.celsius);
  EXPECT_GT(spilled.known.map.spilledTiles(), 10U);
  EXPECT_GT(spilled.own.map.spilledTiles(), 10U);
  EXPECT_GT(in_memory.most_bytes, 8 * limit);
  EXPECT_LE(spilled.most_bytes, 2 * limit);  // the tile in use stays even where it alone exceeds the limit
  EXPECT_TRUE(sameMap(spilled.known.map, in_memory.known.map));
  EXPECT_TRUE(sameMap(spilled.own.map, in_memory.own.map));
}

INSTANTIATE_TEST_SUITE_P(Passes, SpilledSecondLook, testing::Values(Pass::colours, Pass::paint),
                         [](const auto& pass) { return pass.param == Pass::paint ? "Paint" : "Colours"; });

}  // namespace
}  // namespace thermovox::test
