#include "io/station.hpp"

#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::executeSql;
using test::merged;
using test::namesIn;
using test::randomMission;
using test::record;
using test::refusal;
using test::sameMap;
using test::stationOf;
using test::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Station, GivesBackTheMapBitForBit) {
  const TestFolder folder;
  const Station station = Station::open(stationOf(folder, {1}));
  EXPECT_TRUE(sameMap(station.loadMap(), randomMission(1)));
  EXPECT_EQ(station.options(), randomMission(1).options());
  EXPECT_THAT(station.verify(), IsEmpty());
}

TEST(Station, ContinuesWithAFurtherMission) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  Station::open(path).addMission(record("m2"), randomMission(2), KnownMission::refuse);
  const Station station = Station::open(path);
  EXPECT_TRUE(sameMap(station.loadMap(), merged({1, 2})));
  EXPECT_EQ(station.missions().size(), 2U);
  EXPECT_EQ(station.counts().surfaces, static_cast<std::int64_t>(merged({1, 2}).surfaceCount()));
  EXPECT_EQ(station.counts().blocks, static_cast<std::int64_t>(merged({1, 2}).blockCount()));
}

// Whichever way the missions come into it, a station is the same file.
TEST(Station, IsTheSameFileWhateverTheOrderOfItsMissions) {
  const TestFolder folder;
  const std::string one_by_one = test::bytesOf(stationOf(folder, {1, 2, 3}, "abc.tvx"));
  EXPECT_EQ(test::bytesOf(stationOf(folder, {3, 1, 2}, "cab.tvx")), one_by_one);
  const ThermalMap a = randomMission(1), b = randomMission(2), c = randomMission(3);
  const std::vector<Station::Addition> at_once{{record("m2"), &b}, {record("m3"), &c}, {record("m1"), &a}};
  Station::create(folder / "once.tvx", a.options()).addMissions(at_once, KnownMission::refuse);
  EXPECT_EQ(test::bytesOf(folder / "once.tvx"), one_by_one);
}

TEST(Station, IsTheSameFileWhateverTheNumberOfThreads) {
  const TestFolder folder;
  std::vector<std::string> files;
  for (const int threads : {1, 2, 8}) {
    const fs::path path = folder / ("threads" + std::to_string(threads) + ".tvx");
    Station station = Station::create(path, randomMission(0).options(), {.threads = threads});
    station.addMission(record("m1"), randomMission(1), KnownMission::refuse);
    station.addMission(record("m2"), randomMission(2), KnownMission::refuse);
    EXPECT_TRUE(sameMap(station.loadMap(), merged({1, 2})));
    files.push_back(test::bytesOf(path));
  }
  EXPECT_EQ(files[0], files[1]);
  EXPECT_EQ(files[0], files[2]);
}

TEST(Station, RemembersItsMissions) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  MissionRecord empty;
  empty.name = "nothing seen";
  Station::open(path).addMission(empty, ThermalMap(randomMission(0).options()), KnownMission::refuse);
  const std::vector<MissionRecord> missions = Station::open(path).missions();
  ASSERT_EQ(missions.size(), 2U);
  const MissionRecord expected = record("m1");
  EXPECT_EQ(missions[0].name, expected.name);
  EXPECT_EQ(missions[0].rig, expected.rig);
  EXPECT_EQ(missions[0].parameters, expected.parameters);
  EXPECT_EQ(missions[0].readings, expected.readings);
  EXPECT_EQ(missions[0].points, expected.points);
  EXPECT_EQ(missions[0].coloured, expected.coloured);
  EXPECT_EQ(missions[0].first, expected.first);
  EXPECT_EQ(missions[0].last, expected.last);
  EXPECT_EQ(missions[0].version, expected.version);
  EXPECT_EQ(missions[0].mapped_at, expected.mapped_at);
  EXPECT_FALSE(missions[1].first);
  EXPECT_FALSE(missions[1].last);
}

TEST(Station, IsOneFileWhenClosed) {
  const TestFolder folder;
  stationOf(folder, {1, 2});
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("plant.tvx"));
}

TEST(Station, IsNotThereUntilItsFirstMissionIs) {
  const TestFolder folder;
  {
    Station station = Station::create(folder / "plant.tvx", randomMission(0).options());
    EXPECT_FALSE(fs::exists(folder / "plant.tvx"));
    EXPECT_THROW(station.addMission(record("m1"), ThermalMap({.resolution = 0.5}), KnownMission::refuse),
                 ConfigError);
  }
  EXPECT_THAT(namesIn(folder.path()), IsEmpty());
}

TEST(Station, TakesSeveralMissionsOrNone) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const ThermalMap second = randomMission(2), third = randomMission(3);
  const std::vector<Station::Addition> twice{{record("m2"), &second}, {record("m2"), &third}};
  Station station = Station::open(path);
  EXPECT_THROW(station.addMissions(twice, KnownMission::refuse), DataError);
  EXPECT_TRUE(sameMap(station.loadMap(), randomMission(1)));
  const std::vector<Station::Addition> both{{record("m2"), &second}, {record("m3"), &third}};
  station.addMissions(both, KnownMission::refuse);
  EXPECT_TRUE(sameMap(station.loadMap(), merged({1, 2, 3})));
  EXPECT_THAT(station.verify(), IsEmpty());
}

TEST(Station, RefusesAMissionItHas) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  Station station = Station::open(path);
  const auto again = [&] { station.addMission(record("m1"), randomMission(1), KnownMission::refuse); };
  EXPECT_THAT(test::messageOf<DataError>(again), HasSubstr("plant.tvx: has the mission 'm1' already"));
  EXPECT_THROW(station.checkNew("m1"), DataError);
  EXPECT_NO_THROW(station.checkNew("m2"));
  EXPECT_TRUE(sameMap(station.loadMap(), randomMission(1)));
  station.addMission(record("m1"), randomMission(1), KnownMission::add_again);
  EXPECT_TRUE(sameMap(station.loadMap(), merged({1, 1})));
  EXPECT_EQ(station.counts().missions, 2);
}

TEST(Station, RefusesMapsOfOtherCells) {
  const TestFolder folder;
  Station station = Station::open(stationOf(folder, {1}));
  EXPECT_THROW(station.addMission(record("m2"), randomMission(2, 0.2), KnownMission::refuse), ConfigError);
  EXPECT_EQ(station.counts().missions, 1);
}

TEST(Station, RefusesNamesThatAreTaken) {
  const TestFolder folder;
  folder.write("plant.tvx", "mine");
  EXPECT_THROW((void)Station::create(folder / "plant.tvx", {}), DataError);
  EXPECT_THROW((void)Station::create(folder / "no/such/plant.tvx", {}), DataError);
  EXPECT_EQ(test::bytesOf(folder / "plant.tvx"), "mine");
}

}  // namespace
}  // namespace thermovox
