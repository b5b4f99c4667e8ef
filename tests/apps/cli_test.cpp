#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

const std::map<std::string, LaserKind> kLasers{
    {"beam", LaserKind::beam}, {"scan", LaserKind::scan}, {"cloud", LaserKind::cloud}};

TEST(Program, HelpAndVersionAreResultsAndGoToStdout) {
  const TestFolder folder;
  for (const char* arguments : {"--help", "--version", "map --help", "info --help", "overlay --help"}) {
    const Outcome outcome = thermovox(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 0) << arguments;
    EXPECT_THAT(outcome.out, testing::Not(IsEmpty())) << arguments;
    EXPECT_THAT(outcome.err, IsEmpty()) << arguments;
  }
  EXPECT_THAT(thermovox(folder.path(), "--help").out, HasSubstr("Exit codes"));
}

TEST(Program, WrongUsageEndsWithTwoAndIsToldOnStderr) {
  const TestFolder folder;
  for (const char* arguments : {"",
                                "dance",
                                "map",
                                "map hall --no-such-option",
                                "map hall --carve bravely",
                                "map hall --resolution wide",
                                "simulate hall",
                                "simulate hall --laser cloud --frames png",
                                "simulate hall --laser cloud --frames rjpeg --humidity 50",
                                "simulate hall --laser cloud --humidity 0.5",
                                "simulate hall --laser cloud --frames tiff --air 20",
                                "simulate hall --laser sonar",
                                "simulate hall --laser beam --seed x",
                                "export s.tvx",
                                "export s.tvx a.ply b.ply",
                                "export s.tvx a.ply --palette pink",
                                "info",
                                "overlay hall",
                                "overlay hall out --every 0",
                                "export s.tvx map.stl",
                                "export s.tvx map",
                                "export s.tvx a.ply --span 40 20",
                                "export s.tvx a.ply --span nan 20",
                                "overlay hall out --span 40 20",
                                "map hall --points p.txt",
                                "map hall --carve 0",
                                "map hall --resolution nan",
                                "map hall --resolution 0",
                                "map hall --emissivity 95",
                                "map hall --humidity 50",
                                "map hall --window-transmission 0",
                                "map hall --atmosphere-model quarter",
                                "map hall --max-gap 0",
                                "map hall --max-gap nan",
                                "simulate new --laser beam --duration nan",
                                "simulate new --laser beam --duration 0",
                                "simulate new --laser beam --netd -1",
                                "simulate new --laser 0"}) {
    const Outcome outcome = thermovox(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_THAT(outcome.out, IsEmpty()) << arguments;
    EXPECT_THAT(outcome.err, testing::Not(IsEmpty())) << arguments;
  }
  EXPECT_THAT(namesUnder(folder.path()), IsEmpty());
}

TEST(Program, HelpAndErrorsShowTheWordsOfAChoice) {
  const TestFolder folder;
  const std::string help = thermovox(folder.path(), "map --help").out;
  EXPECT_THAT(help, HasSubstr("careful|none|octomap"));
  EXPECT_THAT(help, testing::Not(HasSubstr("{")));
  EXPECT_EQ(thermovox(folder.path(), "map hall --carve bravely").err,
            "thermovox: --carve: found 'bravely', expected careful|none|octomap\n");
  EXPECT_EQ(thermovox(folder.path(), "export s.tvx map.stl").err,
            "thermovox: map.stl: the ending is '.stl', expected .ply, .pcd, .las, .csv, .bt, .ot or .png\n");
}

TEST(Program, AFolderThatIsNotThereIsRefusedByEveryVerbInTheSameWords) {
  const TestFolder folder;
  flyMission(folder, "hall");
  ASSERT_EQ(thermovox(folder.path(), "map hall").code, 0);
  const std::vector<std::string> words{"no/such", "does not exist, expected one to write into"};
  for (const char* arguments : {"simulate no/such/hall --laser beam", "map hall --station no/such/s.tvx",
                                "map hall --station s.tvx --points no/such/p.csv",
                                "export hall.tvx no/such/map.ply", "overlay hall no/such/pictures"}) {
    expectRefused(folder.path(), arguments, words);
  }
}

TEST(Program, ResultsThatCannotBeWrittenAreAFailure) {
  const TestFolder folder;
  flyMission(folder, "hall");
  const Outcome outcome = runShell(folder.path(), std::string(kThermovox) + "info hall >/dev/full");
  expectOneLineOfError(outcome, {"standard output"});
}

TEST(Program, EveryVerbDoesItsWorkWithEveryKindOfLaser) {
  for (const auto& [kind, laser] : kLasers) {
    SCOPED_TRACE(kind);
    const TestFolder folder;
    const Outcome flown =
        thermovox(folder.path(), "simulate hall --laser " + kind + " --duration 1 --seed 5");
    ASSERT_EQ(flown.code, 0) << flown.err;
    EXPECT_THAT(flown.out, HasSubstr("hall.truth.json"));
    const Outcome mapped =
        thermovox(folder.path(), "map hall --station s.tvx --points points.csv --resolution 0.1 --json");
    ASSERT_EQ(mapped.code, 0) << mapped.err;
    EXPECT_THAT(mapped.err, IsEmpty());
    const nlohmann::json account = mapped.json();
    EXPECT_EQ(account.at("mission"), "hall");
    EXPECT_GT(account.at("coloured"), 50);
    EXPECT_EQ(account.at("missions").size(), 1U);
    std::size_t uncoloured = 0;
    for (const auto& reason : account.at("uncoloured")) uncoloured += reason.get<std::size_t>();
    EXPECT_EQ(account.at("points"), account.at("coloured").get<std::size_t>() + uncoloured);
    const std::string record = bytesOf(folder / "points.csv");
    EXPECT_EQ(std::count(record.begin(), record.end(), '\n'),
              account.at("coloured").get<std::ptrdiff_t>() + 1);
    EXPECT_GT(account.at("voxels"), 50);
    EXPECT_GT(account.at("points_per_second"), 0.0);
    ASSERT_EQ(thermovox(folder.path(), "export s.tvx map.ply").code, 0);
    const Outcome drawn = thermovox(folder.path(), "overlay hall pictures/ --every 4");
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_TRUE(fs::exists(folder / "pictures" / "overlay.csv"));
    EXPECT_TRUE(fs::exists(folder / "pictures" / "frame_000000.png"));
    EXPECT_FALSE(fs::exists(folder / "pictures" / "frame_000001.png"));
    EXPECT_THAT(bytesOf(folder / "pictures" / "overlay.csv"),
                HasSubstr(laser == LaserKind::beam ? ",beam," : ",centre,"));
    const nlohmann::json station = thermovox(folder.path(), "info s.tvx --verify --json").json();
    EXPECT_EQ(station.at("ok"), true);
    EXPECT_EQ(station.at("voxels"), account.at("voxels"));
    EXPECT_EQ(namesUnder(folder.path()).count("s.tvx-journal"), 0U);
  }
}

TEST(MapVerb, PlainReportNamesMissionAndStationAndKeepsStderrEmpty) {
  const TestFolder folder;
  flyMission(folder, "hall");
  const Outcome outcome = thermovox(folder.path(), "map hall");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("hall: 100 readings"), HasSubstr("hall.tvx: ")));
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_TRUE(fs::exists(folder / "hall.tvx"));
}

TEST(ExportVerb, EveryEndingGivesItsKindOfFile) {
  const TestFolder folder;
  flyMission(folder, "hall", LaserKind::scan);
  ASSERT_EQ(thermovox(folder.path(), "map hall --resolution 0.1").code, 0);
  const std::map<std::string, std::string> beginnings{{"map.ply", "ply\nformat binary_little_endian"},
                                                      {"map.pcd", "# .PCD v0.7"},
                                                      {"map.csv", "x,y,z"},
                                                      {"map.las", "LASF"},
                                                      {"map.bt", "# Octomap OcTree binary file"},
                                                      {"map.ot", "# Octomap OcTree file"},
                                                      {"map.png", "\x89PNG"}};
  for (const auto& [name, beginning] : beginnings) {
    const Outcome outcome = thermovox(folder.path(), "export hall.tvx " + name + " --span 15 40");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(name));
    EXPECT_THAT(outcome.err, IsEmpty());
    EXPECT_TRUE(bytesOf(folder / name).starts_with(beginning))
        << name << ": " << bytesOf(folder / name).substr(0, 40);
    const std::string before = bytesOf(folder / name);
    expectRefused(folder.path(), "export hall.tvx " + name, {name, "exists already", "--force"});
    EXPECT_TRUE(bytesOf(folder / name) == before);
    EXPECT_EQ(thermovox(folder.path(), "export hall.tvx " + name + " --force --palette grey").code, 0);
  }
}

TEST(ExportVerb, WhatCannotBeExportedIsRefused) {
  const TestFolder folder;
  flyMission(folder, "hall");
  ASSERT_EQ(thermovox(folder.path(), "map hall").code, 0);
  expectRefused(folder.path(), "export hall.tvx no_folder/map.ply", {"no_folder", "does not exist"});
  expectRefused(folder.path(), "export none.tvx map.ply", {"none.tvx", "does not exist"});
  expectRefused(folder.path(), "export hall/rig.yaml map.ply", {"rig.yaml"});
}

/// Runs info with and without --json; the plain text has to have the kind too.
nlohmann::json infoOf(const TestFolder& folder, const std::string& thing) {
  const Outcome plain = thermovox(folder.path(), "info " + thing);
  EXPECT_EQ(plain.code, 0) << plain.err;
  const Outcome outcome = thermovox(folder.path(), "info --json " + thing);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  const nlohmann::json json = outcome.json();
  EXPECT_THAT(plain.out, HasSubstr("kind: " + json.value("kind", "") + "\n"));
  return json;
}

TEST(InfoVerb, TellsEveryKindOfThing) {
  const TestFolder folder;
  flyMission(folder, "hall", LaserKind::scan);
  ASSERT_EQ(thermovox(folder.path(), "map hall --resolution 0.1").code, 0);
  folder.write("captures/captures.yaml",
               "name: board\ncaptures: captures.csv\nrig: ../hall/rig.yaml\nboard: {pattern: chessboard, "
               "inner_corners: [9, 6], square: 0.04, width: 0.5, height: 0.4}\n");
  folder.write("captures/captures.csv",
               "thermal,visible,laser\n../hall/thermal/000000.tiff,,../hall/scans.csv\n");
  folder.write("flight.bag", "#ROSBAG V2.0\n");
  const nlohmann::json mission = infoOf(folder, "hall");
  EXPECT_EQ(mission.at("kind"), "mission");
  EXPECT_EQ(mission.at("readings"), 40);
  EXPECT_GE(mission.at("thermal_frames"), 5);
  EXPECT_EQ(mission.at("rig").at("lasers").at(0).at("kind"), "scan");
  EXPECT_EQ(infoOf(folder, "hall/mission.yaml").at("kind"), "mission");
  const nlohmann::json rig = infoOf(folder, "hall/rig.yaml");
  EXPECT_EQ(rig.at("kind"), "rig");
  EXPECT_EQ(rig.at("thermal_camera").at("width"), 160);
  const nlohmann::json image = infoOf(folder, "hall/thermal/000000.tiff");
  EXPECT_EQ(image.at("kind"), "image");
  EXPECT_EQ(image.at("radiometric"), true);
  EXPECT_EQ(image.at("height"), 120);
  EXPECT_GT(image.at("counts").at("min"), 27000);
  EXPECT_THAT(image.at("note").get<std::string>(), HasSubstr("a guess"));  // until the rig says so
  EXPECT_NEAR(image.at("min").get<double>(), image.at("counts").at("min").get<int>() * 0.01 - 273.15, 1e-3);
  const nlohmann::json station = infoOf(folder, "hall.tvx");
  EXPECT_EQ(station.at("kind"), "station");
  EXPECT_EQ(station.at("missions").at(0).at("mission"), "hall");
  EXPECT_FALSE(station.contains("ok"));
  const nlohmann::json captures = infoOf(folder, "captures");
  EXPECT_EQ(captures.at("kind"), "captures");
  EXPECT_EQ(captures.at("name"), "board");
  EXPECT_EQ(captures.at("captures"), 1);
  EXPECT_EQ(captures.at("thermal"), 1);
  EXPECT_EQ(captures.at("visible"), 0);
  EXPECT_EQ(captures.at("laser"), 1);
  EXPECT_EQ(captures.at("board"), nlohmann::json::parse(R"({"pattern": "chessboard", "columns": 9, "rows": 6,
                                                            "square": 0.04, "width": 0.5, "height": 0.4})"));
  EXPECT_EQ(captures.at("rig").at("lasers").at(0).at("kind"), "scan");
  EXPECT_EQ(infoOf(folder, "captures/captures.yaml").at("kind"), "captures");
  EXPECT_EQ(infoOf(folder, "flight.bag").at("kind"), "bag");
}

TEST(InfoVerb, WhatIsNothingKnownIsRefused) {
  const TestFolder folder;
  folder.write("letter.txt", "Dear station,\n");
  folder.write("empty/letter.txt", "");
  expectRefused(folder.path(), "info none", {"none", "no such file"});
  expectRefused(folder.path(), "info letter.txt --json", {"letter.txt", "expected an image"});
  expectRefused(folder.path(), "info empty", {"empty", "without mission.yaml"});
}

TEST(InfoVerb, VerifyingADamagedStationSaysNotOkAndEndsWithOne) {
  const TestFolder folder;
  flyMission(folder, "hall", LaserKind::cloud);
  ASSERT_EQ(thermovox(folder.path(), "map hall --resolution 0.1").code, 0);
  const std::string sound = bytesOf(folder / "hall.tvx");
  std::string flipped = sound;
  flipped[flipped.size() * 3 / 4] = static_cast<char>(flipped[flipped.size() * 3 / 4] ^ 0x55);
  for (const std::string& damaged : {flipped, sound.substr(0, sound.size() / 2), sound.substr(0, 3000)}) {
    folder.write("hall.tvx", damaged);
    const Outcome outcome = thermovox(folder.path(), "info hall.tvx --verify --json");
    EXPECT_EQ(outcome.code, 1);
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.value("ok", true), false);
    EXPECT_GE(json.at("faults").size(), 1U);
    EXPECT_TRUE(json.at("missions").is_array() && json.at("tiles").is_number());
    EXPECT_THAT(outcome.err, HasSubstr("hall.tvx: the station is damaged"));
    EXPECT_EQ(thermovox(folder.path(), "info hall.tvx --verify").code, 1);
  }
}

TEST(OverlayVerb, RefusesWhatIsThereAndReplacesOnlyOverlays) {
  const TestFolder folder;
  flyMission(folder, "hall");
  fs::create_directory(folder / "empty");
  EXPECT_EQ(thermovox(folder.path(), "overlay hall empty --every 5").code, 0);
  expectRefused(folder.path(), "overlay hall empty", {"empty", "exists already", "--force"});
  EXPECT_EQ(thermovox(folder.path(), "overlay hall empty --every 5 --force").code, 0);
  expectRefused(folder.path(), "overlay hall hall --force", {"hall", "no overlay.csv"});
}

TEST(OverlayVerb, ADamagedFrameLeavesNoFolder) {
  const TestFolder folder;
  flyMission(folder, "hall");
  truncateTo(folder / "hall" / "thermal" / "000003.tiff", 0.5);
  expectRefused(folder.path(), "overlay hall pictures", {"000003.tiff"});
}

TEST(SimulateVerb, RefusesWhatIsThereAndReplacesOnlyMissions) {
  const TestFolder folder;
  const std::string quick = " --laser beam --duration 0.3";
  ASSERT_EQ(thermovox(folder.path(), "simulate hall" + quick).code, 0);
  const std::string before = bytesOf(folder / "hall" / "beam.csv");
  expectRefused(folder.path(), "simulate hall" + quick, {"hall", "exists already"});
  EXPECT_EQ(thermovox(folder.path(), "simulate hall/ --seed 9 --force" + quick).code, 0);
  EXPECT_NE(bytesOf(folder / "hall" / "beam.csv"), before);
  fs::create_directory(folder / "empty");
  EXPECT_EQ(thermovox(folder.path(), "simulate empty" + quick).code, 0);
  folder.write("precious/letter.txt", "Dear station,\n");
  expectRefused(folder.path(), "simulate precious --force" + quick, {"precious", "no mission"});
  EXPECT_EQ(namesUnder(folder.path()).count("hall.old"), 0U);
}

}  // namespace
}  // namespace thermovox::test
