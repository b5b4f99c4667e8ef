#include <chrono>
#include <future>

#include "io/station.hpp"
#include "io/station_file.hpp"
#include "tests/apps/program.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;
using test::expectRefused;
using test::flyMission;
using test::Outcome;
using test::TestFolder;
using testing::HasSubstr;

Outcome thermovoxAtAFixedTime(const TestFolder& folder, const std::string& arguments) {
  return test::runShell(folder.path(),
                        std::string("SOURCE_DATE_EPOCH=1700000000 ") + test::kThermovox + arguments);
}

/// Missions a, b and their stations a.tvx, b.tvx.
void twoStations(const TestFolder& folder) {
  flyMission(folder, "a", LaserKind::beam, 1);
  flyMission(folder, "b", LaserKind::scan, 2);
  for (const char* name : {"a", "b"})
    ASSERT_EQ(thermovoxAtAFixedTime(folder, std::string("map ") + name + " --resolution 0.1").code, 0);
}

TEST(CliMerge, IsMappingAllIntoOneStation) {
  const TestFolder folder;
  twoStations(folder);
  for (const char* line : {"merge a.tvx b.tvx -o ab.tvx", "merge b.tvx a.tvx -o ba.tvx",
                           "map a b --resolution 0.1 --station once.tvx",
                           "map b --resolution 0.1 --station turns.tvx", "map a --station turns.tvx"}) {
    const Outcome outcome = thermovoxAtAFixedTime(folder, line);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  for (const char* name : {"ba.tvx", "once.tvx", "turns.tvx"})
    EXPECT_EQ(bytesOf(folder / name), bytesOf(folder / "ab.tvx")) << name;
}

TEST(CliMerge, TellsWhatItMade) {
  const TestFolder folder;
  twoStations(folder);
  const Outcome outcome = test::thermovox(folder.path(), "merge a.tvx b.tvx -o ab.tvx --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["missions"], 2);
  EXPECT_EQ(json["stations"], 2);
  const Station::Counts counts = Station::open(folder / "ab.tvx").counts();
  EXPECT_EQ(json["voxels"], counts.surfaces);
  EXPECT_EQ(json["tiles"], counts.tiles);
  EXPECT_THAT(test::thermovox(folder.path(), "merge a.tvx b.tvx -o ab.tvx --force").out,
              HasSubstr("ab.tvx: 2 missions of 2 stations"));
}

TEST(CliMerge, RefusesInOneSentence) {
  const TestFolder folder;
  twoStations(folder);
  fs::copy_file(folder / "a.tvx", folder / "again.tvx");
  expectRefused(folder.path(), "merge a.tvx again.tvx -o out.tvx",
                {"the mission 'a' is in both", "a.tvx", "again.tvx"});
  expectRefused(folder.path(), "merge a.tvx b.tvx -o a.tvx --force", {"a.tvx: is one of the stations"});
  expectRefused(folder.path(), "merge a.tvx b.tvx -o again.tvx", {"again.tvx: exists already", "--force"});
  expectRefused(folder.path(), "merge a.tvx nothing.tvx -o out.tvx", {"nothing.tvx: does not exist"});
  expectRefused(folder.path(), "merge a.tvx b.tvx -o no/out.tvx", {"the folder no does not exist"});
  ASSERT_EQ(test::thermovox(folder.path(), "map b --resolution 0.2 --station coarse.tvx").code, 0);
  expectRefused(folder.path(), "merge a.tvx coarse.tvx -o out.tvx",
                {"coarse.tvx: has cells of 0.2 m, expected 0.1 m as in a.tvx"});
}

TEST(CliMerge, RefusesWrongUsageWithTwo) {
  const TestFolder folder;
  twoStations(folder);
  for (const char* arguments :
       {"merge a.tvx -o out.tvx", "merge a.tvx b.tvx", "merge a.tvx b.tvx -o out.tvx --transform '1 2 3'",
        "merge a.tvx b.tvx -o out.tvx --transform '1 2 3 0 0 0 2'",
        "merge a.tvx b.tvx -o out.tvx --transform 'c.tvx=1 2 3 0 0 0 1'"}) {
    const Outcome outcome = test::thermovox(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out.tvx"));
  }
}

TEST(CliMerge, MovesStationsOnRequest) {
  const TestFolder folder;
  twoStations(folder);
  folder.write("pose.txt", "-3 0.5 0\n0 0 0.6 0.8\n");
  for (const char* line : {"merge a.tvx b.tvx -o moved.tvx --transform '-3 0.5 0 0 0 0.6 0.8'",
                           "merge b.tvx a.tvx -o named.tvx --transform b.tvx=pose.txt"}) {
    const Outcome outcome = test::thermovox(folder.path(), line);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(bytesOf(folder / "moved.tvx"), bytesOf(folder / "named.tvx"));
  const Station station = Station::open(folder / "moved.tvx");
  EXPECT_THAT(station.verify(), testing::IsEmpty());
  for (const MissionRecord& mission : station.missions())
    EXPECT_EQ(mission.T_world_mission.has_value(), mission.name == "b");
}

TEST(CliMap, WaitsForAnotherWriterOnceItsWorkIsDoneAndSaysSo) {
  const TestFolder folder;
  flyMission(folder, "a", LaserKind::beam, 1);
  flyMission(folder, "b", LaserKind::beam, 2);
  ASSERT_EQ(test::thermovox(folder.path(), "map a --station s.tvx").code, 0);
  auto other = lockStation(folder / "s.tvx", {});
  auto mapping = std::async(std::launch::async,
                            [&] { return test::thermovox(folder.path(), "map b --station s.tvx 2>words"); });
  const auto waits = [&] {
    return fs::exists(folder / "words") &&
           bytesOf(folder / "words").find("s.tvx: waits for another process") != std::string::npos;
  };
  while (mapping.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready && !waits()) continue;
  EXPECT_TRUE(waits());
  EXPECT_EQ(Station::open(folder / "s.tvx").counts().missions, 1);
  other.reset();
  EXPECT_EQ(mapping.get().code, 0);
  EXPECT_EQ(Station::open(folder / "s.tvx").counts().missions, 2);
}

}  // namespace
}  // namespace thermovox
