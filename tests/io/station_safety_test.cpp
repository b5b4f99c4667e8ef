#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <random>
#include <thread>

#include "io/station_writer.hpp"
#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::executeSql;
using test::merged;
using test::namesIn;
using test::randomMission;
using test::record;
using test::sameMap;
using test::stationOf;
using test::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr uid_t kNobody = 65534;

/// Runs the check in a process of its own, which may not write what this one may not (root could).
template <typename Check>
void expectWithoutPrivileges(Check&& check) {
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && seteuid(kNobody) != 0) _exit(3);
    try {
      _exit(check() ? 0 : 1);
    } catch (const std::exception& error) {
      std::cerr << error.what() << '\n';
      _exit(2);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// Everybody may read the file and its folder, nobody may write.
void protect(const TestFolder& folder, const fs::path& path) {
  constexpr auto read = fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read;
  fs::permissions(path, read);
  fs::permissions(folder.path(),
                  read | fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec);
}

void addSecond(const fs::path& path) {
  Station::open(path).addMission(record("m2"), randomMission(2), KnownMission::refuse);
}

TEST(StationSafety, OpensInAFolderThatCannotBeWritten) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  protect(folder, path);
  expectWithoutPrivileges([&] {
    const Station station = Station::open(path);
    return sameMap(station.loadMap(), randomMission(1)) && station.verify().empty();
  });
  expectWithoutPrivileges([&] {
    return test::messageOf<DataError>([&] { addSecond(path); }).find("is write-protected") !=
           std::string::npos;
  });
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("plant.tvx"));
  fs::permissions(folder.path(), fs::perms::owner_all);
}

// As another program may leave it.
TEST(StationSafety, OpensInWriteAheadModeInAFolderThatCannotBeWritten) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "PRAGMA journal_mode = WAL");
  protect(folder, path);
  expectWithoutPrivileges([&] { return sameMap(Station::open(path).loadMap(), randomMission(1)); });
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("plant.tvx"));
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(StationSafety, RemovesWhatKilledProcessesLeft) {
  const TestFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    const StationWriter writer(folder / "plant.tvx");
    _exit(0);  // without its destructor, as if killed
  }
  waitpid(child, nullptr, 0);
  ASSERT_EQ(namesIn(folder.path()).size(), 1U);
  stationOf(folder, {1});
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("plant.tvx"));
}

// A limit on the size of files stands in for a full disk.
TEST(StationSafety, StaysAsItWasWhenTheDiskIsFull) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{fs::file_size(path), RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = test::messageOf<DataError>([&] { addSecond(path); });
    _exit(message.find("plant.tvx: ") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const Station station = Station::open(path);
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_TRUE(sameMap(station.loadMap(), randomMission(1)));
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("plant.tvx"));
}

TEST(StationSafety, IsAsBeforeOrAsAfterWhenItsWriterIsKilled) {
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

TEST(StationSafety, RecoversWhatAKilledProgramLeftThatWroteInPlace) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const pid_t child = fork();
  if (child == 0) {
    sqlite3* database = nullptr;
    sqlite3_open(path.c_str(), &database);
    sqlite3_exec(database, "PRAGMA cache_size = 1; BEGIN; DELETE FROM tiles; DELETE FROM missions", nullptr,
                 nullptr, nullptr);
    sqlite3_db_cacheflush(database);
    _exit(0);  // without a commit: pages are in the file, the old ones in the journal
  }
  waitpid(child, nullptr, 0);
  ASSERT_THAT(namesIn(folder.path()), testing::UnorderedElementsAre("plant.tvx", "plant.tvx-journal"));
  const Station station = Station::open(path);
  EXPECT_TRUE(sameMap(station.loadMap(), randomMission(1)));
  EXPECT_THAT(station.verify(), IsEmpty());
}

TEST(StationSafety, ASecondWriterIsRefusedWhenItHasWaitedInVain) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  int waits = 0;
  Station station = Station::open(
      path, {.patience = {.most = std::chrono::milliseconds(100), .begins = [&waits] { ++waits; }}});
  const auto add = [&] { station.addMission(record("m2"), randomMission(2), KnownMission::refuse); };
  EXPECT_THAT(test::messageOf<DataError>(add), HasSubstr("plant.tvx: another process is writing it"));
  EXPECT_EQ(waits, 1);
  sqlite3_close(other);
  EXPECT_NO_THROW(add());  // and nothing of the attempt is in the way
}

// As other writers do who were there before.
TEST(StationSafety, ASecondWriterGoesOnToTheFileThatReplacedTheOneItWaitedFor) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1}), next = stationOf(folder, {1, 3}, "next.tvx");
  std::array<sqlite3*, 2> others{};
  for (std::size_t i = 0; i < others.size(); ++i) {
    ASSERT_EQ(sqlite3_open((i == 0 ? path : next).c_str(), &others[i]), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(others[i], "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  }
  int waits = 0;
  const auto finish = [&] {
    ++waits;
    fs::rename(next, path);
    sqlite3_close(others[0]);
  };
  EXPECT_THAT(test::messageOf<DataError>([&] {
                (void)lockStation(path, {.most = std::chrono::milliseconds(100), .begins = finish});
              }),
              HasSubstr("plant.tvx: another process is writing it"));
  EXPECT_EQ(waits, 1);
  Station station =
      Station::open(path, {.patience = {.most = std::nullopt, .begins = [&] { sqlite3_close(others[1]); }}});
  station.addMission(record("m2"), randomMission(2), KnownMission::refuse);
  EXPECT_EQ(test::bytesOf(path), test::bytesOf(stationOf(folder, {1, 2, 3}, "expected.tvx")));
}

TEST(StationSafety, WritersThatWaitAllGetTheirMissionsIn) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  std::vector<pid_t> writers;
  for (const unsigned seed : {2U, 3U, 4U, 5U}) {
    const pid_t child = fork();
    if (child == 0) {
      Station::open(path).addMission(record(test::missionName(seed)), randomMission(seed),
                                     KnownMission::refuse);
      _exit(0);
    }
    writers.push_back(child);
  }
  for (const pid_t writer : writers) {
    int status = 0;
    waitpid(writer, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(test::bytesOf(path), test::bytesOf(stationOf(folder, {1, 2, 3, 4, 5}, "expected.tvx")));
}

TEST(StationSafety, AStationThatAnotherProcessMadeMeanwhileIsContinued) {
  const TestFolder folder;
  Station mine = Station::create(folder / "plant.tvx", randomMission(0).options());
  stationOf(folder, {1});
  mine.addMission(record("m2"), randomMission(2), KnownMission::refuse);
  EXPECT_EQ(test::bytesOf(folder / "plant.tvx"), test::bytesOf(stationOf(folder, {1, 2}, "expected.tvx")));
}

TEST(StationSafety, WhoReadsSeesItAsItWasWhenOpened) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const Station reader = Station::open(path);
  addSecond(path);
  EXPECT_EQ(reader.counts().missions, 1);
  EXPECT_THAT(reader.verify(), IsEmpty());
  EXPECT_TRUE(sameMap(reader.loadMap(), randomMission(1)));
  EXPECT_EQ(Station::open(path).counts().missions, 2);
}

TEST(StationSafety, ReadersNeverSeeAnythingBetween) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const pid_t writer = fork();
  if (writer == 0) {
    for (const unsigned seed : {2U, 3U, 4U, 5U, 6U, 7U}) {
      Station::open(path).addMission(record(test::missionName(seed)), randomMission(seed),
                                     KnownMission::refuse);
    }
    _exit(0);
  }
  int status = 0;
  std::int64_t last = 0;
  while (waitpid(writer, &status, WNOHANG) == 0) {
    const Station station = Station::open(path);
    EXPECT_THAT(station.verify(), IsEmpty());
    EXPECT_GE(station.counts().missions, last);
    last = station.counts().missions;
  }
  EXPECT_EQ(status, 0);
  EXPECT_EQ(Station::open(path).counts().missions, 7);
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("plant.tvx"));
}

TEST(StationSafety, WritesNothingThroughALinkToNothing) {
  const TestFolder folder;
  fs::create_symlink(folder / "nothing.tvx", folder / "link.tvx");
  try {
    Station::checkWritable(folder / "link.tvx");
    FAIL() << "expected a DataError";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is a link to nothing"));
  }
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("link.tvx"));
}

TEST(StationSafety, KeepsPermissionsAndLinksOfTheFileItContinues) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const auto permissions = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(path, permissions);
  fs::create_symlink(path, folder / "link.tvx");
  addSecond(folder / "link.tvx");
  EXPECT_TRUE(fs::is_symlink(folder / "link.tvx"));
  EXPECT_EQ(fs::status(path).permissions(), permissions);
  EXPECT_EQ(Station::open(path).counts().missions, 2);
}

}  // namespace
}  // namespace thermovox
