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
}

TEST(MapVerb, APointsRecordThatIsThereIsKeptUnlessForced) {
  const TestFolder folder;
  flyMission(folder, "hall");
  folder.write("points.csv", "precious");
  expectRefused(folder.path(), "map hall --points points.csv", {"points.csv", "exists already", "--force"});
  EXPECT_EQ(bytesOf(folder / "points.csv"), "precious");
  EXPECT_EQ(thermovox(folder.path(), "map hall --points points.csv --force --all-points").code, 0);
  EXPECT_THAT(bytesOf(folder / "points.csv"),
              testing::AllOf(HasSubstr("timestamp,x,y,z"), HasSubstr(",,,\n")));
  EXPECT_EQ(thermovox(folder.path(), "map hall --station 2.tvx --points points.ply").code, 0);
}

TEST(MapVerb, OfSeveralMissionsAllEnterTheStationOrNone) {
  const TestFolder folder;
  flyMission(folder, "a", LaserKind::scan, 11);
  flyMission(folder, "b", LaserKind::scan, 12);
  flyMission(folder, "c", LaserKind::scan, 13);
  truncateTo(folder / "b" / "thermal" / "000004.tiff", 0.5);
  expectRefused(folder.path(), "map a b --station s.tvx --points p.csv", {"000004.tiff"});
  ASSERT_EQ(mapFixed(folder, "a --station s.tvx").code, 0);
  const std::string first = bytesOf(folder / "s.tvx");
  expectRefused(folder.path(), "map c b --station s.tvx --points p.csv", {"000004.tiff"});
  EXPECT_TRUE(bytesOf(folder / "s.tvx") == first);
}

TEST(MapVerb, ReportsTheMissionsAsNamedAndCallsTheStationAfterTheFirst) {
  const TestFolder folder;
  flyMission(folder, "a", LaserKind::beam, 11);
  flyMission(folder, "b", LaserKind::beam, 12);
  for (const auto& [first, second] : {std::pair("a", "b"), std::pair("b", "a")}) {
    const Outcome outcome = mapFixed(folder, fmt::format("{} {} --json", first, second));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.json().at("missions").at(0).at("mission"), first);
    EXPECT_EQ(outcome.json().at("missions").at(1).at("mission"), second);
    EXPECT_TRUE(fs::exists(folder / (std::string(first) + ".tvx")));
  }
}

/// The stamps of a points record, as texts of one length.
std::vector<std::string> stampsOf(const fs::path& record) {
  std::vector<std::string> stamps;
  std::ifstream stream(record);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) stamps.push_back(line.substr(0, line.find(',')));
  return stamps;
}

TEST(MapVerb, PointsAreInTimeOrderWhateverTheStampsOfTheSweeps) {
  const TestFolder folder;
  folder.write("m/mission.yaml",
               "name: m\nrig: rig.yaml\ntrajectory: trajectory.tum\nlaser: [clouds.csv, beam.csv]\n");
  const std::string mounted =
      "range_min: 0.1, range_max: 40, range_sigma: 0.01,"
      " T_body_laser: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}}\n";
  folder.write("m/rig.yaml", "laser:\n  - {kind: cloud, " + mounted + "  - {kind: beam, " + mounted);
  std::string poses;
  for (int i = 0; i < 20; ++i) poses += fmt::format("{:.1f} {} 0 0 0 0 0 1\n", 10.0 + 0.1 * i, 0.1 * i);
  folder.write("m/trajectory.tum", poses);
  std::string clouds;
  std::string beams;
  for (int i = 0; i < 10; ++i) {  // a sweep is stamped when it ends
    clouds += fmt::format("{:.1f},sweep.ply\n", 10.5 + 0.1 * i);
    for (int j = 0; j < 10; ++j) beams += fmt::format("{:.3f},5\n", 10.4 + 0.1 * i + 0.01 * j + 0.003);
  }
  folder.write("m/clouds.csv", clouds);
  folder.write("m/beam.csv", beams);
  std::string sweep =
      "ply\nformat ascii 1.0\nelement vertex 20\nproperty float x\nproperty float y\nproperty float z\n"
      "property float time\nend_header\n";
  for (int i = 0; i < 20; ++i) sweep += fmt::format("5 {} 0 {:.3f}\n", i, -0.1 + 0.005 * i);
  folder.write("m/sweep.ply", sweep);
  const Outcome outcome = thermovox(folder.path(), "map m --points p.csv --all-points");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<std::string> stamps = stampsOf(folder / "p.csv");
  EXPECT_EQ(stamps.size(), 300U);
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
}

TEST(MapVerb, PointsOfMissionsThatOverlapInTimeAreInTimeOrder) {
  const TestFolder folder;
  flyMission(folder, "a", LaserKind::scan, 11);
  fs::copy(folder / "a", folder / "b", fs::copy_options::recursive);
  const std::string mission = bytesOf(folder / "b" / "mission.yaml");
  folder.write("b/mission.yaml", "name: b" + mission.substr(mission.find('\n')));
  ASSERT_EQ(thermovox(folder.path(), "map a b --points p.csv").code, 0);
  const std::vector<std::string> stamps = stampsOf(folder / "p.csv");
  EXPECT_GT(stamps.size(), 1000U);
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
}

TEST(MapVerb, AKilledRunLeavesNothing) {
  const TestFolder folder;
  simulate::SimulationOptions options;
  options.duration = 4.0;
  options.supersampling = 1;
  simulate::simulateMission(options, folder / "hall");
  std::set<std::string> allowed = namesUnder(folder.path());
  const std::string arguments = std::string(kThermovox) + "map hall --station s.tvx --points p.csv --force";
  for (const char* delay : {"0.05", "0.2", "0.4"}) {
    (void)runShell(folder.path(), std::string("timeout -s TERM ") + delay + " " + arguments);
    fs::remove(folder / "s.tvx");  // where the run was quicker
    fs::remove(folder / "p.csv");
    EXPECT_EQ(namesUnder(folder.path()), allowed) << delay;
  }
  ASSERT_EQ(runShell(folder.path(), arguments).code, 0);
  allowed.insert({"s.tvx", "p.csv"});
  EXPECT_EQ(namesUnder(folder.path()), allowed);
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
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("hall/mission.yaml"), HasSubstr("hall/rig.yaml"),
                                          HasSubstr("has no thermal_camera")));
  EXPECT_EQ(json.at("uncoloured").at("no_camera"), json.at("points"));
  EXPECT_EQ(thermovox(folder.path(), "export hall.tvx map.png").code, 0);
  expectRefused(folder.path(), "overlay hall pictures", {"hall", "no thermal images"});
}

TEST(MapVerb, WarnsOfACameraWithoutImages) {
  const TestFolder folder;
  flyMission(folder, "hall");
  replaceIn(folder / "hall" / "mission.yaml", "thermal: thermal.csv\n", "");
  const Outcome outcome = thermovox(folder.path(), "map hall");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("hall/mission.yaml lists no thermal images"),
                                          HasSubstr("hall/rig.yaml")));
}

TEST(MapVerb, WarnsOnceOfAScaleThatTheRigAndTheImagesLeaveOpenOrContradict) {
  const TestFolder folder;
  flyMission(folder, "hall");
  const std::string rig = bytesOf(folder / "hall" / "rig.yaml");
  const auto warned = [&](const std::string& arguments) {
    const Outcome outcome = thermovox(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  };
  replaceIn(folder / "hall/rig.yaml", "  celsius_per_count: 0.01\n  celsius_offset: -273.15\n", "");
  for (const char* arguments :
       {"map hall", "map hall --station two.tvx --two-pass", "overlay hall pictures"}) {
    EXPECT_THAT(warned(arguments),
                testing::AllOf(HasSubstr("tiff: does not say what its counts mean"),
                               HasSubstr("celsius_per_count and celsius_offset of the rig")));
  }
  EXPECT_THAT(thermovox(folder.path(), "map hall --station again.tvx --json").out, testing::StartsWith("{"));
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
