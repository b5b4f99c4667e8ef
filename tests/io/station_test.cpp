#include "io/station.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <random>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::randomMission;
using test::sameMap;
using test::TestFolder;
using testing::HasSubstr;
using testing::IsEmpty;

MissionRecord record(const std::string& name) {
  return {.name = name,
          .rig = "laser: {kind: beam}\n",
          .parameters = "resolution: 0.1\n",
          .readings = 5,
          .points = 1000,
          .coloured = 666,
          .first = Time(Duration(-5)),
          .last = Time(Duration(1'700'000'000'123'456'789)),
          .version = "0.1.0",
          .mapped_at = 1'700'000'100};
}

std::string missionName(unsigned seed) {
  return std::string("m").append(std::to_string(seed));
}

/// A station of missions named m1, m2 ... of these seeds.
fs::path stationOf(const TestFolder& folder, const std::vector<unsigned>& seeds,
                   const char* name = "plant.tvx") {
  const fs::path path = folder / name;
  Station station = Station::create(path, randomMission(0).options());
  for (const unsigned seed : seeds) {
    station.addMission(record(missionName(seed)), randomMission(seed), KnownMission::refuse);
  }
  return path;
}

ThermalMap merged(const std::vector<unsigned>& seeds) {
  ThermalMap map(randomMission(0).options());
  for (const unsigned seed : seeds) map.merge(randomMission(seed));
  return map;
}

void executeSql(const fs::path& path, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

std::string refusal(const fs::path& path) {
  return test::messageOf<DataError>([&] { (void)Station::open(path).loadMap(); });
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

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

TEST(Station, DoesNotDependOnTheOrderOfMissions) {
  const TestFolder folder;
  const Station ab = Station::open(stationOf(folder, {1, 2, 3}, "ab.tvx"));
  const Station ba = Station::open(stationOf(folder, {3, 1, 2}, "ba.tvx"));
  EXPECT_TRUE(sameMap(ab.loadMap(), ba.loadMap()));
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
  EXPECT_THAT(namesIn(folder.path()), testing::ElementsAre("plant.tvx"));
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

TEST(Station, RemovesWhatKilledProcessesLeft) {
  const TestFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    const Station station = Station::create(folder / "plant.tvx", randomMission(0).options());
    _exit(0);  // without its destructor, as if killed
  }
  waitpid(child, nullptr, 0);
  const std::string living = "plant.tvx." + std::to_string(::getppid()) + ".unfinished";
  folder.write(living, "of another process");
  ASSERT_EQ(namesIn(folder.path()).size(), 2U);
  stationOf(folder, {1});
  EXPECT_THAT(namesIn(folder.path()), testing::UnorderedElementsAre("plant.tvx", living));
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

TEST(Station, RefusesWhatIsNoStation) {
  const TestFolder folder;
  EXPECT_THAT(refusal(folder / "nothing.tvx"), HasSubstr("nothing.tvx: does not exist"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a folder"));
  EXPECT_THAT(refusal(folder.write("empty.tvx", "")), HasSubstr("empty.tvx: is empty"));
  EXPECT_THAT(refusal(folder.write("text.tvx", std::string(5000, 'x'))),
              HasSubstr("text.tvx: is not a station"));
  executeSql(folder / "other.tvx", "CREATE TABLE t (a); INSERT INTO t VALUES (1)");
  EXPECT_THAT(refusal(folder / "other.tvx"), HasSubstr("other.tvx: is a SQLite database but not a station"));
}

TEST(Station, RefusesANewerVersion) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "PRAGMA user_version = 2");
  EXPECT_THAT(refusal(path), HasSubstr("written by a newer thermovox (station version 2)"));
}

TEST(Station, RefusesTruncatedFiles) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const std::string bytes = test::bytesOf(path);
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.99}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    SCOPED_TRACE(size);
    EXPECT_THAT(refusal(folder.write("part.tvx", bytes.substr(0, size))), HasSubstr("part.tvx: "));
  }
}

TEST(Station, SaysWhichTileIsDamaged) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path,
             "UPDATE tiles SET data = CAST(substr(data, 1, 100) || x'00' || substr(data, 102) AS BLOB)"
             " WHERE x = -1 AND y = -1 AND z = -1");
  EXPECT_THAT(refusal(path), HasSubstr("plant.tvx: tile (-1, -1, -1) is damaged"));
  EXPECT_THAT(Station::open(path).verify(), testing::ElementsAre(HasSubstr("tile (-1, -1, -1) is damaged")));
}

TEST(Station, RefusesTilesOutsideTheWorld) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "UPDATE tiles SET x = 2147483647 WHERE x = -1");
  EXPECT_THAT(refusal(path), HasSubstr("has a tile at 2147483647"));
}

TEST(Station, VerifiesItsCounts) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "UPDATE tiles SET surfaces = surfaces + 1 WHERE x = 0 AND y = 0 AND z = 0");
  EXPECT_THAT(Station::open(path).verify(),
              testing::ElementsAre(HasSubstr("is damaged, it holds"), HasSubstr("than it says")));
}

TEST(Station, NoticesLostTilesAndMissions) {
  const TestFolder folder;
  for (const char* loss : {"DELETE FROM tiles WHERE x = -1 AND y = -1 AND z = -1", "DELETE FROM tiles",
                           "DELETE FROM missions WHERE id = 2"}) {
    SCOPED_TRACE(loss);
    const fs::path path = stationOf(folder, {1, 2});
    executeSql(path, loss);
    Station station = Station::open(path);
    EXPECT_THAT(station.verify(), testing::ElementsAre(HasSubstr("plant.tvx: is damaged, it holds")));
    // A further mission must not make the loss look right.
    EXPECT_THROW(station.addMission(record("m3"), randomMission(3), KnownMission::refuse), DataError);
    fs::remove(path);
  }
}

TEST(Station, RefusesMetaThatIsGone) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "DELETE FROM meta WHERE key = 'resolution'");
  EXPECT_THAT(refusal(path), HasSubstr("no number for resolution"));
}

TEST(Station, OpensInAFolderThatCannotBeWritten) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  fs::permissions(path, fs::perms::owner_read);
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_TRUE(sameMap(Station::open(path).loadMap(), randomMission(1)));
  EXPECT_THAT(namesIn(folder.path()), testing::ElementsAre("plant.tvx"));
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(Station, WritesTheSameBytesTwice) {
  const TestFolder folder;
  EXPECT_EQ(test::bytesOf(stationOf(folder, {1, 2}, "a.tvx")),
            test::bytesOf(stationOf(folder, {1, 2}, "b.tvx")));
}

// A limit on the size of files stands in for a full disk.
TEST(Station, StaysAsItWasWhenTheDiskIsFull) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{fs::file_size(path) + 4096, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      Station::open(path).addMission(record("m2"), randomMission(2), KnownMission::refuse);
      _exit(1);
    } catch (const DataError& error) {
      _exit(std::string(error.what()).find("plant.tvx: ") != std::string::npos ? 0 : 2);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const Station station = Station::open(path);
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_TRUE(sameMap(station.loadMap(), randomMission(1)));
}

TEST(Station, IsAsBeforeOrAsAfterWhenItsWriterIsKilled) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const ThermalMap before = randomMission(1), after = merged({1, 2}), second = randomMission(2);
  std::mt19937 rng(17);
  std::uniform_int_distribution<int> delay_us(0, 30000);
  int whole = 0;
  for (int i = 0; i < 25; ++i) {
    const fs::path copy = folder / "copy.tvx";
    fs::copy_file(path, copy, fs::copy_options::overwrite_existing);
    const pid_t child = fork();
    if (child == 0) {
      Station::open(copy).addMission(record("m2"), second, KnownMission::refuse);
      _exit(0);
    }
    usleep(static_cast<unsigned>(delay_us(rng)));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const Station station = Station::open(copy);
    EXPECT_THAT(station.verify(), IsEmpty());
    const bool has_second = station.counts().missions == 2;
    whole += has_second;
    EXPECT_TRUE(sameMap(station.loadMap(), has_second ? after : before));
  }
  RecordProperty("whole", whole);
}

TEST(Station, ASecondWriterIsToldToWait) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  Station station = Station::open(path);
  EXPECT_THAT(test::messageOf<DataError>(
                  [&] { station.addMission(record("m2"), randomMission(2), KnownMission::refuse); }),
              HasSubstr("another process is writing it"));
  sqlite3_close(other);
}

}  // namespace
}  // namespace thermovox
