#include <fcntl.h>
#include <unistd.h>

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

/// Kills runs that add a mission to a station, with these options, at any moment: the mission is in it wholly
/// or not at all, and what lies beside it the next run removes.
void expectWhollyOrNotAtAll(const TestFolder& folder, LaserKind laser,
                            const std::vector<std::string>& options) {
  const std::string monday = flyMission(folder, "monday", laser).string();
  const std::string tuesday = flyMission(folder, "tuesday", laser, 12).string();
  const std::string station = folder / "plant.tvx";
  std::vector<std::string> add{"map", tuesday, "--station", station};
  run({"map", monday, "--station", station, "--resolution", "0.08"});
  add.insert(add.end(), options.begin(), options.end());
  const std::string before = bytesOf(station);
  const double whole = run(add);
  const std::string after = bytesOf(station);
  const std::set<std::string> names = namesUnder(folder.path());
  std::mt19937_64 rng(23);
  int killed = 0, with_mission = 0;
  for (int i = 0; i < kills(); ++i) {
    std::ofstream(station, std::ios::binary) << before;
    const double moment = whole * 1.1 * static_cast<double>(rng() >> 11) * 0x1p-53;
    killed += killAfter(moment, add);
    expectSound(station);
    const std::string now = bytesOf(station);
    EXPECT_TRUE(now == before || now == after) << "killed after " << moment << " s";
    with_mission += now == after;
  }
  std::cout << killed << " runs killed on the way, " << with_mission << " with the mission in the station\n";
  std::ofstream(station, std::ios::binary) << before;
  run(add);
  EXPECT_EQ(bytesOf(station), after);
  EXPECT_EQ(namesUnder(folder.path()), names);
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

TEST(CliKill, AMergeIsThereWhollyOrNotAtAll) {
  const TestFolder folder;
  const fs::path out = folder / "all.tvx";
  std::vector<std::string> stations;
  for (const std::uint64_t seed : {21U, 22U, 23U}) {
    const fs::path mission = flyMission(folder, fmt::format("m{}", seed), LaserKind::scan, seed);
    stations.push_back(folder / fmt::format("s{}.tvx", seed));
    run({"map", mission.string(), "--resolution", "0.02", "--station", stations.back()});
  }
  const std::vector<std::string> merge{"merge", stations[0], stations[1], stations[2], "-o", out.string()};
  const double whole = run(merge);
  const std::string expected = bytesOf(out), input = bytesOf(stations[0]);
  std::mt19937_64 rng(29);
  int killed = 0, merged = 0;
  for (int i = 0; i < kills(); ++i) {
    fs::remove(out);
    const double moment = whole * 1.1 * static_cast<double>(rng() >> 11) * 0x1p-53;
    killed += killAfter(moment, merge);
    if (fs::exists(out)) {
      ++merged;
      expectSound(out);
      EXPECT_EQ(bytesOf(out), expected);
    }
    EXPECT_EQ(bytesOf(stations[0]), input);
  }
  std::cout << killed << " merges killed on the way, " << merged << " were there\n";
}

}  // namespace
}  // namespace thermovox
