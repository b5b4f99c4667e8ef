#include "io/station_hotspots.hpp"

#include "tests/io/hot_stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::hotMission;
using test::HotPeak;
using test::hotRecord;
using test::messageOf;
using test::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const HotPeak kLeft{{0.45, 0.75, 1.02}, 30.0, 0.06}, kRight{{1.05, 0.75, 1.02}, 40.0, 0.06};

/// A station of missions on consecutive days, added in the order that is asked for.
class StationHotspotsOf : public testing::Test {
 protected:
  fs::path station(const char* name, const std::vector<int>& days) {
    const fs::path path = folder_ / name;
    Station station = Station::create(path, ThermalMap::Options{});
    for (const int day : days) {
      const std::vector<HotPeak> peaks = day == 0 ? std::vector{kLeft} : std::vector{kLeft, kRight};
      station.addMission(hotRecord("day " + std::to_string(day), day), hotMission(peaks, day),
                         KnownMission::refuse);
    }
    return path;
  }
  fs::path stationOf(MissionRecord mission) {
    Station::create(folder_ / "one.tvx", ThermalMap::Options{})
        .addMission(mission, hotMission({kLeft}, 0), KnownMission::refuse);
    return folder_ / "one.tvx";
  }

  TestFolder folder_;
};

TEST_F(StationHotspotsOf, FollowsTheMissionsInTheOrderOfTheirFlights) {
  const StationHotspots found = stationHotspots(Station::open(station("a.tvx", {2, 0, 1})), {});
  ASSERT_THAT(found.missions, SizeIs(3));
  ASSERT_THAT(found.layers, SizeIs(3));
  EXPECT_EQ(found.missions[0].name, "day 0");
  EXPECT_EQ(found.missions[2].name, "day 2");
  EXPECT_THAT(found.without_layer, IsEmpty());
  ASSERT_THAT(found.history.tracks(), SizeIs(2));
  EXPECT_NEAR(found.history.tracks()[0].seen[0]->position.p_world.x(), 0.45, 0.01);
  EXPECT_NEAR(found.history.tracks()[1].seen[1]->position.p_world.x(), 1.05, 0.01);
  EXPECT_EQ(found.history.tracks()[1].changes[1]->state, HotspotState::fresh);
  EXPECT_EQ(found.history.tracks()[1].changes[2]->state, HotspotState::steady);
}

TEST_F(StationHotspotsOf, KeepsTheIdsWhenALaterMissionComes) {
  const StationHotspots before = stationHotspots(Station::open(station("a.tvx", {0, 1})), {});
  const StationHotspots after = stationHotspots(Station::open(station("b.tvx", {0, 1, 2, 3})), {});
  ASSERT_EQ(before.history.tracks().size(), after.history.tracks().size());
  for (std::size_t i = 0; i < before.history.tracks().size(); ++i) {
    EXPECT_EQ(before.history.tracks()[i].id, after.history.tracks()[i].id);
    EXPECT_EQ(before.history.tracks()[i].seen[1]->position.p_world,
              after.history.tracks()[i].seen[1]->position.p_world);
  }
}

TEST_F(StationHotspotsOf, FindsNothingAsItShould) {
  const Station station = Station::open(stationOf(hotRecord("day 0", 0)));
  const StationHotspots found = stationHotspots(station, {.above = 500.0, .delta = std::nullopt});
  EXPECT_THAT(found.missions, SizeIs(1));
  EXPECT_THAT(found.history.tracks(), IsEmpty());
}

TEST_F(StationHotspotsOf, AddsWhatTheMissionDeclares) {
  MissionRecord mission = hotRecord("day 0", 0);
  mission.pose_sigmas.translation = 0.03;
  SharedMotion motion;
  motion.cube = {0, 0, 1};
  motion.count = 9;
  motion.view = {0.0F, 0.0F, -1.0F};
  mission.shared_motions = {motion};
  mission.frame_poses = {{*mission.first, {expRotation({M_PI, 0, 0}), {0.45, 0.75, 4.02}}}};
  const StationHotspots found = stationHotspots(Station::open(stationOf(mission)), {});
  ASSERT_THAT(found.history.tracks(), SizeIs(1));
  const Hotspot& spot = *found.history.tracks()[0].seen[0];
  EXPECT_LT((spot.position.common - 9e-4 * Eigen::Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_EQ(spot.bias_sigma, 2.0);  // of its rig's camera
  ASSERT_TRUE(spot.best_frame);
  EXPECT_EQ(spot.best_frame->stamp, *mission.first);
  EXPECT_NEAR(spot.best_frame->pixel.x(), 79.5, 1.0);
}

TEST_F(StationHotspotsOf, AMissionOfGeometryIsLeftOut) {
  const fs::path path = station("a.tvx", {0});
  MissionRecord geometry = hotRecord("dark", 1);
  geometry.coloured = 0;
  Station::open(path).addMission(geometry, ThermalMap({}), KnownMission::refuse);
  const StationHotspots found = stationHotspots(Station::open(path), {});
  EXPECT_THAT(found.missions, SizeIs(1));
  EXPECT_THAT(found.without_layer, IsEmpty());
}

TEST_F(StationHotspotsOf, RefusesLasersThatTheRigDoesNotHave) {
  MissionRecord mission = hotRecord("day 0", 0);
  SharedMotion motion;
  motion.laser = 1;
  motion.count = 1;
  mission.shared_motions = {motion};
  const Station station = Station::open(stationOf(mission));
  EXPECT_THAT(messageOf<DataError>([&] { (void)stationHotspots(station, {}); }),
              HasSubstr("mission 'day 0' has returns of laser 1, expected less than the 1"));
}

TEST_F(StationHotspotsOf, NamesTheMissionWhoseRigIsNone) {
  MissionRecord mission = hotRecord("day 0", 0);
  mission.rig = "laser: {kind: sonar}\n";
  const Station station = Station::open(stationOf(mission));
  EXPECT_THAT(messageOf<Error>([&] { (void)stationHotspots(station, {}); }),
              HasSubstr("one.tvx: the rig of mission 'day 0'"));
}

/// The stations that older programs wrote still answer: the sum of their missions as one.
TEST(OldStations, GiveTheHotSpotsOfTheSumOfTheirMissions) {
  for (const char* name : {"station_v1.tvx", "station_v2.tvx"}) {
    SCOPED_TRACE(name);
    const Station station = Station::open(fs::path(THERMOVOX_SOURCE_DIR) / "tests" / "data" / name);
    const StationHotspots found = stationHotspots(station, {.above = 25.0, .delta = std::nullopt});
    ASSERT_THAT(found.missions, SizeIs(1));
    EXPECT_EQ(found.missions[0].name, "monday, tuesday");
    EXPECT_THAT(found.without_layer, ElementsAre("monday", "tuesday"));
    EXPECT_EQ(found.missions[0].last, std::max(station.missions()[0].last, station.missions()[1].last));
    EXPECT_GT(found.layers.at(0)->samples().size(), 100U);
    for (const HotspotTrack& track : found.history.tracks()) {
      EXPECT_TRUE(track.seen[0]->position.common.isZero());  // nobody has kept it
    }
  }
}

TEST(OldStations, FollowTheMissionsThatCameSince) {
  const TestFolder folder;
  const fs::path path = folder / "plant.tvx";
  fs::copy_file(fs::path(THERMOVOX_SOURCE_DIR) / "tests" / "data" / "station_v2.tvx", path);
  const ThermalMap::Options options = Station::open(path).options();
  const ThermalMap hot =
      test::mapOf(test::returnsOf({.length = 3.0, .width = 3.0, .step = 0.05, .line_step = 0.05},
                                  [](const Eigen::Vector3d& p) {
                                    return 20.0 + test::riseAt({{{1.5, 1.5, 1.02}, 60.0, 0.3}}, p);
                                  }),
                  options.resolution);
  ThermalMap mission(options);
  mission.merge(hot);
  Station::open(path).addMission(hotRecord("now", 30'000), mission, KnownMission::refuse);
  const StationHotspots found = stationHotspots(Station::open(path), {});
  ASSERT_THAT(found.missions, SizeIs(1));
  EXPECT_EQ(found.missions[0].name, "now");
  EXPECT_THAT(found.without_layer, ElementsAre("monday", "tuesday"));
  EXPECT_THAT(found.history.tracks(), SizeIs(1));
}

}  // namespace
}  // namespace thermovox
