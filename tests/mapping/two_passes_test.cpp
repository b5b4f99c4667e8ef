#include "mapping/two_passes.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mapping/imported_geometry.hpp"
#include "projection/error.hpp"
#include "tests/mapping/synthetic_mission.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox::test {
namespace {

using Pass = MissionMapper::Pass;

/// The wall that the laser sees, and a post that an imported cloud knows.
struct Scene {
  const Mission mission = missionOf(poses(0.5, 0.0));
  ThermalMap known{ThermalMap::Options{}};

  Scene() {
    std::vector<Eigen::Vector3d> post;
    for (int z = -20; z < 20; ++z) post.emplace_back(3.02, 1.52, 0.05 * z + 0.02);
    addGeometry(post, known);
  }
};

std::vector<Reading> sweeps() {
  std::vector<Reading> readings;
  for (int i = 0; i < 30; ++i) readings.push_back(readingAt(11.0 + 0.1 * i, 60));
  return readings;
}

std::vector<ThermalFrame> frames() {
  std::vector<ThermalFrame> frames;
  for (int i = 0; i < 15; ++i) frames.push_back(frameAt(11.0 + kPeriod * i, 20.0 + i));
  return frames;
}

class MapMissionTwice : public testing::TestWithParam<Pass> {};

TEST_P(MapMissionTwice, IsGeometryAndThenALookAtAllOfIt) {
  const Scene scene;
  Readings first(sweeps()), second(sweeps());
  Frames seen(frames());
  ThermalMap expected{ThermalMap::Options{}};
  (void)mapMission({scene.mission, first, nullptr}, expected, {});
  SceneSurfaces surfaces({&scene.known, &expected});
  const MissionReport by_hand =
      mapMission({scene.mission, second, &seen}, expected, {.pass = GetParam(), .scene = &surfaces});

  Readings first_again(sweeps()), second_again(sweeps());
  Frames unread(frames()), seen_again(frames());
  ThermalMap map{ThermalMap::Options{}};
  std::size_t heard = 0, points = 0;
  const TwoPasses passes{
      .geometry = {scene.mission, first_again, &unread},
      .look = {scene.mission, second_again, &seen_again},
      .geometry_listeners = {.points = {}, .progress = [&](Time) { ++heard; }},
      .look_listeners = {.points = [&](std::span<const ColouredReturn> some) { points += some.size(); },
                         .progress = {}}};
  const MissionReport report = mapMissionTwice(passes, map, {&scene.known}, {.pass = GetParam()});
  EXPECT_GT(report.coloured, 100U);
  EXPECT_EQ(report.coloured, by_hand.coloured);
  EXPECT_EQ(report.painted, by_hand.painted);
  EXPECT_EQ(heard, 30U);
  EXPECT_EQ(points, report.points);
  EXPECT_TRUE(sameMap(map, expected));
}

INSTANTIATE_TEST_SUITE_P(Passes, MapMissionTwice, testing::Values(Pass::colours, Pass::paint),
                         [](const auto& pass) { return pass.param == Pass::paint ? "Paint" : "Colours"; });

TEST(MapMissionTwiceOnce, IsRefused) {
  const Scene scene;
  Readings first(sweeps()), second(sweeps());
  ThermalMap map{ThermalMap::Options{}};
  const TwoPasses passes{.geometry = {scene.mission, first}, .look = {scene.mission, second}};
  EXPECT_THROW((void)mapMissionTwice(passes, map, {}, {.pass = Pass::only}), ConfigError);
}

}  // namespace
}  // namespace thermovox::test
