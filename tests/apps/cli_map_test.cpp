// The verb map and its station: what is the same, what is kept, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Runs map with the time of mapping fixed, so that stations can be compared byte by byte.
Outcome mapFixed(const TestFolder& folder, const std::string& arguments) {
  return runShell(folder.path(),
                  std::string("SOURCE_DATE_EPOCH=1700000000 ") + kThermovox + "map " + arguments);
}

TEST(MapVerb, SameInputGivesTheSameBytesInAnyOrderOfTheMissions) {
  const TestFolder folder;
  flyMission(folder, "a", LaserKind::scan, 11);
  flyMission(folder, "b", LaserKind::cloud, 12);
  for (const char* arguments : {"a b --station 1.tvx --points 1.csv", "b a --station 2.tvx --points 2.csv",
                                "a b --station 3.tvx --points 3.csv"}) {
    const Outcome outcome = mapFixed(folder, std::string(arguments) + " --json --resolution 0.1");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.at("missions").size(), 2U);
    EXPECT_FALSE(json.contains("mission"));  // at the top only where there is one
  }
  for (const char* ending : {".tvx", ".csv"}) {
    EXPECT_TRUE(bytesOf(folder / std::string("1").append(ending)) ==
                bytesOf(folder / std::string("2").append(ending)));
    EXPECT_TRUE(bytesOf(folder / std::string("1").append(ending)) ==
                bytesOf(folder / std::string("3").append(ending)));
  }
}

TEST(MapVerb, TheTimeOfMappingIsNowUnlessItIsFixed) {
  const TestFolder folder;
  flyMission(folder, "a");
  const auto mappedAt = [&](const std::string& station) {
    return runShell(folder.path(), "sqlite3 " + station + " 'SELECT mapped_at FROM missions'").out;
  };
  ASSERT_EQ(mapFixed(folder, "a --station fixed.tvx").code, 0);
  ASSERT_EQ(thermovox(folder.path(), "map a --station now.tvx").code, 0);
  EXPECT_NE(bytesOf(folder / "fixed.tvx"), bytesOf(folder / "now.tvx"));
  const Outcome outcome = runShell(
      folder.path(), std::string("SOURCE_DATE_EPOCH=yesterday ") + kThermovox + "map a --station x.tvx");
  expectOneLineOfError(outcome, {"SOURCE_DATE_EPOCH", "'yesterday'"});
  if (runShell(folder.path(), "command -v sqlite3").code != 0) GTEST_SKIP() << "sqlite3 is not installed";
  EXPECT_EQ(mappedAt("fixed.tvx"), "1700000000\n");
  EXPECT_GT(std::stoll(mappedAt("now.tvx")), 1'700'000'000);
}

TEST(MapVerb, ContinuingAStationIsTheSameAsMappingBothAtOnce) {
  const TestFolder folder;
  flyMission(folder, "a", LaserKind::scan, 11);
  flyMission(folder, "b", LaserKind::scan, 12);
  ASSERT_EQ(mapFixed(folder, "a b --station both.tvx --resolution 0.1").code, 0);
  ASSERT_EQ(mapFixed(folder, "a --station s.tvx --resolution 0.1").code, 0);
  ASSERT_EQ(mapFixed(folder, "b --station s.tvx").code, 0);  // with the station's own resolution
  for (const char* station : {"both", "s"}) {
    const std::string name = station;
    ASSERT_EQ(thermovox(folder.path(), "export " + name + ".tvx " + name + ".csv").code, 0);
    ASSERT_EQ(thermovox(folder.path(), "export " + name + ".tvx " + name + ".bt").code, 0);
  }
  EXPECT_TRUE(bytesOf(folder / "both.csv") == bytesOf(folder / "s.csv"));
  EXPECT_TRUE(bytesOf(folder / "both.bt") == bytesOf(folder / "s.bt"));
  const nlohmann::json info = thermovox(folder.path(), "info s.tvx --json").json();
  EXPECT_EQ(info.at("missions").size(), 2U);
  EXPECT_EQ(info.at("resolution"), 0.1);
}

TEST(MapVerb, TheSameMissionTwiceIsRefusedUnlessItIsMeant) {
  const TestFolder folder;
  flyMission(folder, "hall");
  ASSERT_EQ(thermovox(folder.path(), "map hall --station s.tvx").code, 0);
  const std::string before = bytesOf(folder / "s.tvx");
  expectRefused(folder.path(), "map hall --station s.tvx --points p.csv", {"s.tvx", "'hall'", "--again"});
  EXPECT_TRUE(bytesOf(folder / "s.tvx") == before);
  EXPECT_EQ(thermovox(folder.path(), "map hall --station s.tvx --again").code, 0);
  EXPECT_EQ(thermovox(folder.path(), "info s.tvx --json").json().at("missions").size(), 2U);
  expectRefused(folder.path(), "map hall hall --station new.tvx", {"new.tvx", "'hall'", "--again"});
  EXPECT_EQ(thermovox(folder.path(), "map hall hall --station new.tvx --again").code, 0);
}

TEST(MapVerb, AResolutionThatIsNotTheStationsIsRefused) {
  const TestFolder folder;
  flyMission(folder, "a");
  flyMission(folder, "b", LaserKind::beam, 12);
  ASSERT_EQ(thermovox(folder.path(), "map a --station s.tvx --resolution 0.1").code, 0);
  expectRefused(folder.path(), "map b --station s.tvx --resolution 0.05", {"s.tvx", "0.1", "0.05"});
  EXPECT_EQ(thermovox(folder.path(), "map b --station s.tvx --resolution 0.1").code, 0);
  for (const char* nonsense : {"0", "-1", "nan", "inf"}) {
    expectRefused(folder.path(), std::string("map a --station t.tvx --resolution=") + nonsense,
                  {"resolution"});
  }
  for (const char* nonsense : {"0", "-1", "nan", "1e300"}) {
    expectRefused(folder.path(), std::string("map a --station t.tvx --max-gap=") + nonsense, {"max-gap"});
  }
}

TEST(MapVerb, APointsRecordThatIsThereIsKeptUnlessForced) {
  const TestFolder folder;
  flyMission(folder, "hall");
  folder.write("points.csv", "precious");
  expectRefused(folder.path(), "map hall --points points.csv", {"points.csv", "exists already", "--force"});
  EXPECT_EQ(bytesOf(folder / "points.csv"), "precious");
  expectRefused(folder.path(), "map hall --points points.txt", {"points.txt", ".csv or .ply"});
  EXPECT_EQ(thermovox(folder.path(), "map hall --points points.csv --force --all-points").code, 0);
  EXPECT_THAT(bytesOf(folder / "points.csv"),
              testing::AllOf(HasSubstr("timestamp,x,y,z"), HasSubstr(",,,\n")));
  EXPECT_EQ(thermovox(folder.path(), "map hall --station 2.tvx --points points.ply").code, 0);
}

TEST(MapVerb, ADamagedSecondMissionLeavesTheStationWithTheFirstWhole) {
  const TestFolder folder;
  flyMission(folder, "a", LaserKind::scan, 11);
  flyMission(folder, "b", LaserKind::scan, 12);
  truncateTo(folder / "b" / "thermal" / "000004.tiff", 0.5);
  ASSERT_EQ(mapFixed(folder, "a --station alone.tvx").code, 0);
  const std::set<std::string> before = namesUnder(folder.path());
  expectOneLineOfError(mapFixed(folder, "a b --station s.tvx --points p.csv"), {"000004.tiff"});
  std::set<std::string> expected = before;
  expected.insert("s.tvx");
  EXPECT_EQ(namesUnder(folder.path()), expected);
  EXPECT_TRUE(bytesOf(folder / "s.tvx") == bytesOf(folder / "alone.tvx"));
  EXPECT_EQ(thermovox(folder.path(), "info s.tvx --verify --json").json().at("ok"), true);
  const std::string first = bytesOf(folder / "s.tvx");
  expectRefused(folder.path(), "map b --station s.tvx", {"000004.tiff"});
  EXPECT_TRUE(bytesOf(folder / "s.tvx") == first);
}

TEST(MapVerb, ARigWithoutCameraMapsGeometryOnly) {
  const TestFolder folder;
  flyMission(folder, "hall", LaserKind::scan);
  const std::string rig = bytesOf(folder / "hall" / "rig.yaml");
  const std::size_t camera = rig.find("thermal_camera:");
  const std::size_t laser = rig.find("laser:");
  ASSERT_TRUE(camera != std::string::npos && laser != std::string::npos && camera < laser);
  folder.write("hall/rig.yaml", rig.substr(0, camera) + rig.substr(laser));
  const Outcome outcome = thermovox(folder.path(), "map hall --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json.at("coloured"), 0);
  EXPECT_EQ(json.at("uncoloured").at("no_camera"), json.at("points"));
  EXPECT_EQ(thermovox(folder.path(), "export hall.tvx map.png").code, 0);
  expectRefused(folder.path(), "overlay hall pictures", {"hall", "no thermal images"});
}

TEST(MapVerb, NotOneColourWhereColoursWereToBeExpectedIsAnErrorWithItsLikelyCause) {
  const TestFolder folder;
  flyMission(folder, "hall");
  std::ofstream(folder / "hall" / "mission.yaml", std::ios::app) << "camera_time_offset: 1000.0\n";
  expectRefused(folder.path(), "map hall --points p.csv", {"hall", "no_frame", "camera_time_offset"});
  expectRefused(folder.path(), "overlay hall pictures", {"hall", "clocks"});
}

}  // namespace
}  // namespace thermovox::test
