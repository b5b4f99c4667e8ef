#include "io/station_merge.hpp"

#include <random>

#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;
using test::executeSql;
using test::messageOf;
using test::namesIn;
using test::randomMission;
using test::record;
using test::sameMap;
using test::stationOf;
using test::TestFolder;
using testing::HasSubstr;
using testing::IsEmpty;

Station::Counts merge(const std::vector<fs::path>& stations, const fs::path& output,
                      Existing existing = Existing::refuse) {
  std::vector<MergeInput> inputs;
  for (const fs::path& station : stations) inputs.push_back({station, std::nullopt});
  return mergeStations(inputs, output, existing);
}

TEST(StationMerge, IsMappingAllInWhateverOrder) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx"), b = stationOf(folder, {2, 3}, "b.tvx"),
                 c = stationOf(folder, {4}, "c.tvx");
  const std::string expected = bytesOf(stationOf(folder, {1, 2, 3, 4}, "all.tvx"));
  int number = 0;
  for (const std::vector<fs::path>& order :
       std::vector<std::vector<fs::path>>{{a, b, c}, {c, b, a}, {b, a, c}, {b, c, a}}) {
    const fs::path out = folder / ("out" + std::to_string(number++) + ".tvx");
    EXPECT_EQ(merge(order, out).missions, 4);
    EXPECT_EQ(bytesOf(out), expected);
  }
  merge({a, b}, folder / "ab.tvx");
  merge({c, folder / "ab.tvx"}, folder / "cab.tvx");
  EXPECT_EQ(bytesOf(folder / "cab.tvx"), expected);
}

TEST(StationMerge, LeavesItsInputsAsTheyAre) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx"), b = stationOf(folder, {2}, "b.tvx");
  const std::string before_a = bytesOf(a), before_b = bytesOf(b);
  merge({a, b}, folder / "out.tvx");
  EXPECT_EQ(bytesOf(a), before_a);
  EXPECT_EQ(bytesOf(b), before_b);
  EXPECT_THAT(namesIn(folder.path()), testing::UnorderedElementsAre("a.tvx", "b.tvx", "out.tvx"));
}

TEST(StationMerge, OfOneStationIsThatStation) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1, 2}, "a.tvx");
  merge({a}, folder / "out.tvx");
  EXPECT_EQ(bytesOf(folder / "out.tvx"), bytesOf(a));
}

TEST(StationMerge, RefusesAMissionThatIsInBoth) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1, 2}, "a.tvx"), b = stationOf(folder, {2, 3}, "b.tvx");
  const std::string message = messageOf<DataError>([&] { merge({a, b}, folder / "out.tvx"); });
  for (const char* words : {"the mission 'm2' is in both", "a.tvx", "b.tvx"})
    EXPECT_THAT(message, HasSubstr(words));
  EXPECT_FALSE(fs::exists(folder / "out.tvx"));
}

TEST(StationMerge, RefusesOtherCellsModelsAndFrames) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx");
  Station::create(folder / "coarse.tvx", {.resolution = 0.2})
      .addMission(record("m2"), ThermalMap({.resolution = 0.2}), KnownMission::refuse);
  EXPECT_THAT(messageOf<ConfigError>([&] {
                merge({a, folder / "coarse.tvx"}, folder / "out.tvx");
              }),
              HasSubstr("coarse.tvx: has cells of 0.2 m, expected 0.1 m as in"));
  const ThermalMap::Options surer{.resolution = 0.1, .occupancy = {.prob_hit = 0.8}};
  Station::create(folder / "surer.tvx", surer)
      .addMission(record("m2"), ThermalMap(surer), KnownMission::refuse);
  EXPECT_THAT(messageOf<ConfigError>([&] {
                merge({a, folder / "surer.tvx"}, folder / "out.tvx");
              }),
              HasSubstr("surer.tvx: has another occupancy model"));
  const fs::path b = stationOf(folder, {2}, "b.tvx");
  executeSql(b, "UPDATE meta SET value = 'another' WHERE key = 'frame'");
  EXPECT_THAT(messageOf<ConfigError>([&] {
                merge({a, b}, folder / "out.tvx");
              }),
              HasSubstr("b.tvx: has the frame 'another'"));
}

TEST(StationMerge, RefusesOutputsThatAreInputsOrTaken) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx"), b = stationOf(folder, {2}, "b.tvx");
  fs::create_symlink(a, folder / "link.tvx");
  for (const fs::path& output : {a, b, fs::path(folder / "link.tvx")}) {
    EXPECT_THAT(messageOf<DataError>([&] {
                  merge({a, b}, output, Existing::replace);
                }),
                HasSubstr("is one of the stations to merge"));
  }
  EXPECT_THAT(messageOf<DataError>([&] {
                merge({a, folder / "link.tvx"}, folder / "out.tvx");
              }),
              HasSubstr("is given twice"));
  folder.write("taken.tvx", "mine");
  EXPECT_THROW(merge({a, b}, folder / "taken.tvx"), DataError);
  EXPECT_EQ(bytesOf(folder / "taken.tvx"), "mine");
  merge({a, b}, folder / "taken.tvx", Existing::replace);
  EXPECT_EQ(bytesOf(folder / "taken.tvx"), bytesOf(stationOf(folder, {1, 2}, "ab.tvx")));
}

TEST(StationMerge, WaitsForWhoeverWritesTheStationThatItReplaces) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx"), b = stationOf(folder, {2}, "b.tvx"),
                 out = stationOf(folder, {3}, "out.tvx");
  const std::string before = bytesOf(out);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(out.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  int waits = 0;
  const auto replace = [&](std::optional<std::chrono::milliseconds> most, std::function<void()> begins) {
    mergeStations(std::vector<MergeInput>{{a, std::nullopt}, {b, std::nullopt}}, out, Existing::replace,
                  {.patience = {most, std::move(begins)}});
  };
  EXPECT_THAT(messageOf<DataError>([&] { replace(std::chrono::milliseconds(60), [&] { ++waits; }); }),
              HasSubstr("out.tvx: another process is writing it"));
  EXPECT_EQ(waits, 1);
  EXPECT_TRUE(bytesOf(out) == before);
  EXPECT_THAT(namesIn(folder.path()), testing::UnorderedElementsAre("a.tvx", "b.tvx", "out.tvx"));
  replace(std::nullopt, [&] { sqlite3_close(other); });
  EXPECT_TRUE(bytesOf(out) == bytesOf(stationOf(folder, {1, 2}, "ab.tvx")));
}

TEST(StationMerge, RefusesADamagedStation) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx"), b = stationOf(folder, {2}, "b.tvx");
  executeSql(b, "DELETE FROM tiles WHERE x = -1");
  EXPECT_THAT(messageOf<DataError>([&] {
                merge({a, b}, folder / "out.tvx");
              }),
              HasSubstr("b.tvx: is damaged"));
  EXPECT_FALSE(fs::exists(folder / "out.tvx"));
}

/// Changes one byte of a tile and leaves its row in place.
void damageTile(const fs::path& station, const char* where) {
  const std::string sql =
      "UPDATE tiles SET data = CAST(substr(data, 1, 100) || x'00' || substr(data, 102) AS BLOB) WHERE ";
  executeSql(station, (sql + where).c_str());
}

TEST(StationMerge, RefusesADamagedTileThatOneStationAloneHas) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx");
  ThermalMap far(randomMission(0).options());
  const Eigen::Vector3d p_world(100.05, 100.05, 0.05);
  far.integrate({{{p_world, p_world, Time{}, std::nullopt}}}, Carving::none);
  Station::create(folder / "b.tvx", far.options()).addMission(record("far"), far, KnownMission::refuse);
  const std::string expected = bytesOf(folder / "b.tvx");
  damageTile(a, "x = -1 AND y = -1 AND z = -1");
  for (const fs::path& first : {a, fs::path(folder / "b.tvx")}) {
    const fs::path& second = first == a ? fs::path(folder / "b.tvx") : a;
    EXPECT_THAT(messageOf<DataError>([&] {
                  merge({first, second}, folder / "out.tvx");
                }),
                HasSubstr("a.tvx: tile (-1, -1, -1) is damaged"));
  }
  EXPECT_THAT(namesIn(folder.path()), testing::UnorderedElementsAre("a.tvx", "b.tvx"));
  EXPECT_EQ(bytesOf(folder / "b.tvx"), expected);
}

TEST(StationMerge, RefusesATileThatHoldsOtherThanItSays) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx");
  executeSql(a,
             "UPDATE tiles SET surfaces = surfaces - 1 WHERE x = -1 AND y = -1 AND z = -1;"
             "UPDATE meta SET value = value - 1 WHERE key = 'surfaces'");
  EXPECT_THAT(messageOf<DataError>([&] { merge({a}, folder / "out.tvx"); }),
              HasSubstr("a.tvx: is damaged, a tile holds another number of blocks or surfaces than it says"));
}

TEST(StationMerge, MovesAStationOnRequest) {
  const TestFolder folder;
  const fs::path a = stationOf(folder, {1}, "a.tvx"), b = stationOf(folder, {2}, "b.tvx");
  const Pose by_blocks{Eigen::Quaterniond::Identity(), {0.8, -1.6, 0.0}};
  const std::vector<MergeInput> inputs{{a, std::nullopt}, {b, by_blocks}};
  mergeStations(inputs, folder / "out.tvx", Existing::refuse);
  const Station station = Station::open(folder / "out.tvx");
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_FALSE(station.missions().at(0).T_world_mission);
  EXPECT_EQ(station.missions().at(1).T_world_mission, by_blocks);
  mergeStations(inputs, folder / "narrow.tvx", Existing::refuse, {.threads = 2, .memory_bytes = 50'000});
  EXPECT_TRUE(bytesOf(folder / "narrow.tvx") == bytesOf(folder / "out.tvx"));
  // Moved once more, the motions of its missions add up.
  mergeStations(std::vector<MergeInput>{{folder / "out.tvx", by_blocks}}, folder / "twice.tvx",
                Existing::refuse);
  const Pose twice = by_blocks * by_blocks;
  EXPECT_EQ(Station::open(folder / "twice.tvx").missions().at(1).T_world_mission, twice);
}

}  // namespace
}  // namespace thermovox
