#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <random>

#include "io/station.hpp"
#include "tests/apps/program.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;
using test::flyMission;
using test::namesUnder;
using test::TestFolder;

/// How often a run is killed: THERMOVOX_KILLS, or a few times only.
int kills() {
  const char* wanted = std::getenv("THERMOVOX_KILLS");
  return wanted == nullptr ? 12 : std::max(1, std::atoi(wanted));
}

/// Starts thermovox with these arguments, silent, at a fixed time of mapping.
pid_t start(std::vector<std::string> arguments) {
  const pid_t child = fork();
  if (child != 0) return child;
  ::setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {0, 1, 2}) ::dup2(nothing, stream);
  arguments.insert(arguments.begin(), THERMOVOX_PROGRAM);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  ::execv(THERMOVOX_PROGRAM, words.data());
  _exit(127);
}

/// Runs it to its end; the seconds it took.
double run(const std::vector<std::string>& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  int status = 0;
  ::waitpid(start(arguments), &status, 0);
  EXPECT_EQ(status, 0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Runs it and kills it after so many seconds; whether that was before its end.
bool killAfter(double seconds, const std::vector<std::string>& arguments) {
  const pid_t child = start(arguments);
  ::usleep(static_cast<useconds_t>(seconds * 1e6));
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

void expectSound(const fs::path& station) {
  EXPECT_THAT(Station::open(station).verify(), testing::IsEmpty());
}

std::size_t unfinishedIn(const TestFolder& folder) {
  const std::set<std::string> names = namesUnder(folder.path());
  return static_cast<std::size_t>(std::count_if(
      names.begin(), names.end(), [](const std::string& n) { return n.ends_with(".unfinished"); }));
}

/// Kills runs as soon as an unfinished file is to be seen, until one of them leaves it there.
bool leavesUnfinished(const TestFolder& folder, const std::vector<std::string>& arguments) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    const pid_t child = start(arguments);
    int status = 0;
    bool ended = false;
    while (!ended && unfinishedIn(folder) == 0) ended = ::waitpid(child, &status, WNOHANG) == child;
    if (ended) continue;
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    if (unfinishedIn(folder) > 0) return true;
  }
  return false;
}

/// Kills runs that write a station at any moment: it is as it was before, or not there where it was not, or
/// as a whole run leaves it, and what lies beside it the next run removes.
void expectAsBeforeOrAsAfter(const TestFolder& folder, const fs::path& station,
                             const std::vector<std::string>& arguments) {
  const auto content = [&] { return fs::exists(station) ? bytesOf(station) : std::string(); };
  const std::string before = content();
  const auto restore = [&] {
    fs::remove(station);
    if (!before.empty()) std::ofstream(station, std::ios::binary) << before;
  };
  const double whole = run(arguments);
  const std::string after = content();
  const std::set<std::string> names = namesUnder(folder.path());
  EXPECT_NE(before, after);
  std::mt19937_64 rng(23);
  int killed = 0, written = 0;
  for (int i = 0; i < kills(); ++i) {
    restore();
    const double moment = whole * 1.1 * static_cast<double>(rng() >> 11) * 0x1p-53;
    killed += killAfter(moment, arguments);
    const std::string now = content();
    EXPECT_TRUE(now == before || now == after) << "killed after " << moment << " s";
    if (!now.empty()) expectSound(station);
    written += now == after;
  }
  std::cout << killed << " runs killed on the way, " << written << " had put the station into place\n";
  restore();
  EXPECT_TRUE(leavesUnfinished(folder, arguments));
  restore();
  run(arguments);
  EXPECT_TRUE(content() == after);
  EXPECT_EQ(namesUnder(folder.path()), names);
}

/// The same for runs that add a mission to a station, with these options.
void expectWhollyOrNotAtAll(const TestFolder& folder, LaserKind laser,
                            const std::vector<std::string>& options) {
  const std::string monday = flyMission(folder, "monday", laser).string();
  const std::string tuesday = flyMission(folder, "tuesday", laser, 12).string();
  const std::string station = folder / "plant.tvx";
  std::vector<std::string> add{"map", tuesday, "--station", station};
  run({"map", monday, "--station", station, "--resolution", "0.08"});
  add.insert(add.end(), options.begin(), options.end());
  expectAsBeforeOrAsAfter(folder, station, add);
}

TEST(CliKill, AStationHasTheMissionWhollyOrNotAtAll) {
  expectWhollyOrNotAtAll(TestFolder(), LaserKind::scan, {});
}

TEST(CliKill, SoItIsWhileTilesWaitInAFile) {
  const TestFolder folder;
  expectWhollyOrNotAtAll(folder, LaserKind::cloud, {"--memory", "1"});
  const test::Outcome narrow =
      test::thermovox(folder.path(), "map tuesday --memory 1 --json --station n.tvx");
  EXPECT_GT(narrow.json().at("spilled_tiles"), 10);
}

TEST(CliKill, SoItIsOfASecondLook) {
  expectWhollyOrNotAtAll(TestFolder(), LaserKind::scan, {"--two-pass"});
}

TEST(CliKill, SoItIsOfPaintingWhileTilesWaitInAFile) {
  expectWhollyOrNotAtAll(TestFolder(), LaserKind::cloud, {"--paint", "--memory", "2"});
}

TEST(CliKill, AStationOfVersion1IsThatOrHasTheMission) {
  const TestFolder folder;
  const std::string mission = flyMission(folder, "today", LaserKind::scan).string();
  const fs::path station = folder / "old.tvx";
  fs::copy_file(fs::path(THERMOVOX_SOURCE_DIR) / "tests" / "data" / "station_v1.tvx", station);
  expectAsBeforeOrAsAfter(folder, station, {"map", mission, "--station", station.string()});
}

/// The stations of three missions, with cells of this edge (metres).
std::vector<std::string> threeStations(const TestFolder& folder, const char* resolution = "0.02") {
  std::vector<std::string> stations;
  for (const std::uint64_t seed : {21U, 22U, 23U}) {
    const fs::path mission = flyMission(folder, fmt::format("m{}", seed), LaserKind::scan, seed);
    stations.push_back(folder / fmt::format("s{}.tvx", seed));
    run({"map", mission.string(), "--resolution", resolution, "--station", stations.back()});
  }
  return stations;
}

TEST(CliKill, AMergeIsThereWhollyOrNotAtAll) {
  const TestFolder folder;
  const std::vector<std::string> s = threeStations(folder);
  const std::string input = bytesOf(s[0]);
  expectAsBeforeOrAsAfter(folder, folder / "all.tvx", {"merge", s[0], s[1], s[2], "-o", folder / "all.tvx"});
  EXPECT_TRUE(bytesOf(s[0]) == input);
}

TEST(CliKill, AMergeOverAStationIsThatOrTheMerge) {
  const TestFolder folder;
  const std::vector<std::string> s = threeStations(folder);
  expectAsBeforeOrAsAfter(folder, s[2], {"merge", s[0], s[1], "-o", s[2], "--force"});
}

TEST(CliKill, AMergeThatMovesAStationIsThereWhollyOrNotAtAll) {
  const TestFolder folder;
  const std::vector<std::string> s = threeStations(folder, "0.05");
  expectAsBeforeOrAsAfter(
      folder, folder / "all.tvx",
      {"merge", s[0], s[1], "-o", folder / "all.tvx", "--transform", "1 0.5 0 0 0 0.6 0.8", "--memory", "1"});
}

}  // namespace
}  // namespace thermovox
