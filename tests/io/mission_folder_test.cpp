#include "io/mission_folder.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <map>

#include "projection/error.hpp"
#include "tests/io/tiff_writer.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view kMission = R"(name: yard
rig: rig.yaml
trajectory: trajectory.tum
thermal: thermal.csv
laser: beam.csv
pose_sigma: {rotation: 0.002, translation: 0.01}
camera_time_offset: 0.25
ambient: 21.5
)";
constexpr std::string_view kRig = R"(thermal_camera:
  {width: 4, height: 3, model: pinhole, fx: 4, fy: 4, cx: 1.5, cy: 1, celsius_per_count: 0.01,
   celsius_offset: -273.15, T_body_camera: {translation: [0, 0, 0], quaternion_xyzw: [-0.5, 0.5, -0.5, 0.5]}}
laser: {kind: beam, range_min: 0.1, range_max: 40, range_sigma: 0.01,
        T_body_laser: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}}
)";

/// A small mission with a beam and two thermal frames, one of them a page of a TIFF with two.
class MissionFolder : public testing::Test {
 protected:
  MissionFolder() {
    folder.write("mission.yaml", kMission);
    folder.write("rig.yaml", kRig);
    folder.write("trajectory.tum", "10 0 0 0 0 0 0 1\n10.5 1 0 0 0 0 0 1\n11 2 0 0 0 0 0 1\n");
    folder.write("beam.csv", "timestamp,range\n10.1,5\n10.2,6\n");
    folder.write("thermal.csv", "timestamp,file,page\n10,one.tiff\n10.2,two.tiff,1\n");
    writeTiff(folder / "one.tiff", pages({30000}));
    writeTiff(folder / "two.tiff", pages({31000, 32000}));
  }

  static test::TiffPages<std::uint16_t> pages(const std::vector<std::uint16_t>& counts) {
    test::TiffPages<std::uint16_t> pages{4, 3, {}};
    for (const std::uint16_t count : counts) pages.pages.emplace_back(12, count);
    return pages;
  }

  void replace(const char* file, std::string_view old_part, std::string_view new_part) const {
    std::string text = test::bytesOf(folder / file);
    const std::size_t place = text.find(old_part);
    ASSERT_NE(place, std::string::npos) << old_part;
    folder.write(file, text.replace(place, old_part.size(), new_part));
  }

  /// Opens the mission and reads both streams to their ends.
  void readAll() const {
    OpenedMission mission = openMission(folder.path());
    while (mission.readings->next()) {
    }
    while (mission.frames && mission.frames->next()) {
    }
  }
  template <typename Exception>
  std::string complaint() const {
    return messageOf<Exception>([this] { readAll(); });
  }

  test::TestFolder folder;
};

TEST_F(MissionFolder, OpensWithAllItSays) {
  const OpenedMission opened = openMission(folder.path(), {.max_gap = std::chrono::seconds(3)});
  EXPECT_EQ(opened.mission.name, "yard");
  EXPECT_EQ(opened.mission.pose_rotation_sigma, 0.002);
  EXPECT_EQ(opened.mission.pose_translation_sigma, 0.01);
  EXPECT_EQ(opened.mission.camera_time_offset, std::chrono::milliseconds(250));
  EXPECT_EQ(opened.mission.ambient, 21.5);
  EXPECT_EQ(opened.mission.trajectory.poses().size(), 3U);
  EXPECT_EQ(opened.mission.trajectory.maxGap(), std::chrono::seconds(3));
  EXPECT_EQ(opened.rig_file, folder / "rig.yaml");
  EXPECT_FALSE(opened.visible_list);
  EXPECT_EQ(opened.readings->next()->returns.at(0).range(), 5.0);
  EXPECT_EQ(opened.readings->next()->returns.at(0).range(), 6.0);
  EXPECT_FALSE(opened.readings->next());
}

TEST_F(MissionFolder, StampsItsFramesWithTheCamerasOffset) {
  const OpenedMission opened = openMission(folder / "mission.yaml");
  ASSERT_TRUE(opened.frames);
  EXPECT_EQ(opened.frames->period(), std::chrono::milliseconds(200));
  const auto first = opened.frames->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(formatTime(first->stamp), "10.250000000");
  EXPECT_EQ(first->name, "one.tiff");
  EXPECT_FLOAT_EQ(first->image->at(3, 2), 26.85F);
  const auto second = opened.frames->next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->name, "two.tiff page 1");
  EXPECT_FLOAT_EQ(second->image->at(0, 0), 46.85F);
  EXPECT_FALSE(opened.frames->next());
}

TEST_F(MissionFolder, HasNoFramesWithoutACameraOrWithoutImages) {
  replace("mission.yaml", "thermal: thermal.csv\n", "");
  EXPECT_FALSE(openMission(folder.path()).frames);
  folder.write("mission.yaml", kMission);
  folder.write("rig.yaml", kRig.substr(kRig.find("laser:")));
  EXPECT_FALSE(openMission(folder.path()).frames);
}

TEST_F(MissionFolder, MergesTheReadingsOfSeveralLasers) {
  folder.write("second.csv", "10.15,7\n10.2,8\n");
  replace("mission.yaml", "beam.csv", "[beam.csv, second.csv]");
  const std::string laser(kRig.substr(kRig.find("{kind")));
  replace("rig.yaml", laser, "[" + laser + ", " + laser + "]\n");
  const OpenedMission opened = openMission(folder.path());
  std::vector<std::pair<double, std::size_t>> order;
  while (const auto reading = opened.readings->next()) {
    order.emplace_back(reading->returns.at(0).range(), reading->laser);
  }
  EXPECT_THAT(order, testing::ElementsAre(std::pair(5.0, 0), std::pair(7.0, 1), std::pair(6.0, 0),
                                          std::pair(8.0, 1)));
}

TEST_F(MissionFolder, WantsARecordingForEachLaser) {
  replace("mission.yaml", "beam.csv", "[beam.csv, beam.csv]");
  EXPECT_THAT(complaint<ConfigError>(), HasSubstr("mission.yaml, laser: names 2 recording(s), expected 1"));
}

TEST_F(MissionFolder, NamesTheMissingFileAndWhoNamesIt) {
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(openMission(folder / "elsewhere")); }),
              HasSubstr("elsewhere: no such mission"));
  for (const auto& [file, key] : {std::pair("rig.yaml", "rig"), std::pair("trajectory.tum", "trajectory"),
                                  std::pair("beam.csv", "laser"), std::pair("thermal.csv", "thermal")}) {
    const std::string content = test::bytesOf(folder / file);
    std::filesystem::remove(folder / file);
    EXPECT_THAT(complaint<DataError>(),
                HasSubstr(std::string(file) + " (named by " + (folder / "mission.yaml").string() + ", " +
                          key + "): no such file"));
    folder.write(file, content);
  }
  std::filesystem::remove(folder / "two.tiff");
  EXPECT_THAT(complaint<DataError>(),
              AllOf(HasSubstr("two.tiff (named by "), HasSubstr("thermal.csv:3): no such file")));
  std::filesystem::remove(folder / "mission.yaml");
  EXPECT_THAT(complaint<DataError>(), HasSubstr("mission.yaml: no such file"));
}

TEST_F(MissionFolder, RefusesAnImageOfAnotherSizeThanTheRigs) {
  replace("rig.yaml", "width: 4", "width: 5");
  EXPECT_THAT(complaint<DataError>(),
              AllOf(HasSubstr("one.tiff: is 4 x 3 pixels"), HasSubstr("expected 5 x 3")));
}

TEST_F(MissionFolder, RefusesAnEmptyMission) {
  folder.write("beam.csv", "timestamp,range\n");
  EXPECT_THAT(complaint<DataError>(), HasSubstr("mission.yaml: the mission is empty"));
}

TEST_F(MissionFolder, RefusesFramesWhoseClockRunsBackwards) {
  folder.write("thermal.csv", "10.2,one.tiff\n10,one.tiff\n");
  EXPECT_THAT(complaint<DataError>(),
              HasSubstr("thermal.csv:2: timestamp 10.000000000 follows 10.200000000"));
  folder.write("thermal.csv", "10.2,one.tiff,-1\n");
  EXPECT_THAT(complaint<DataError>(), HasSubstr("thermal.csv:1: found page '-1'"));
}

TEST_F(MissionFolder, RefusesNamesThatNoStationShouldHave) {
  for (const char* name : {".hidden", "'two/parts'", "\"tab\\t\"", "bad\xFF"}) {
    SCOPED_TRACE(name);
    const std::string text = std::string("name: ") + name + "\nrig: r\ntrajectory: t\nlaser: l\n";
    EXPECT_THAT(messageOf<ConfigError>([&] { (void)parseMissionFile(text, "mission.yaml"); }),
                HasSubstr("mission.yaml, name: found"));
  }
}

TEST_F(MissionFolder, SaysWhatIsNoMission) {
  const std::map<std::string, std::string> files{
      {"SQLite format 3", "a station"}, {"#ROSBAG V2.0\n", "a ROS bag"}, {"# .PCD v.7\n", "a point cloud"}};
  for (const auto& [head, kind] : files) {
    const auto file = folder.write("thing", head + std::string(1, '\0'));
    EXPECT_THAT(messageOf<DataError>([&] { (void)openMission(file); }),
                AllOf(HasSubstr("is " + kind), HasSubstr("expected a mission folder")));
  }
}

TEST_F(MissionFolder, RefusesPipesInsteadOfWaitingForTheirWriters) {
  std::filesystem::remove(folder / "beam.csv");
  ASSERT_EQ(::mkfifo((folder / "beam.csv").c_str(), 0600), 0);
  EXPECT_THAT(complaint<DataError>(), AllOf(HasSubstr("beam.csv"), HasSubstr("expected a regular file")));
}

TEST_F(MissionFolder, RefusesAListWithoutImages) {
  folder.write("thermal.csv", "timestamp,file\n");
  EXPECT_THAT(complaint<DataError>(), AllOf(HasSubstr("thermal.csv"), HasSubstr("lists no image")));
}

TEST_F(MissionFolder, MayKnowTheObjectsAndTheAirBetterThanItsImages) {
  const std::string text = "name: a\nrig: r\ntrajectory: t\nlaser: l\nambient: 12\n";
  EXPECT_FALSE(parseMissionFile(text, "mission.yaml").radiometry.any());
  const MissionFile mission =
      parseMissionFile(text + "humidity: 0.55\nemissivity: 0.9\nreflected: -10\n", "mission.yaml");
  EXPECT_EQ(mission.radiometry,
            (RadiometricOverrides{.emissivity = 0.9, .reflected = -10.0, .humidity = 0.55}));
}

TEST_F(MissionFolder, RefusesWhatMissionFilesDoNotSay) {
  const auto complaintAbout = [](const std::string& text) {
    return messageOf<ConfigError>([&] { static_cast<void>(parseMissionFile(text, "mission.yaml")); });
  };
  const std::string least = "name: a\nrig: r\ntrajectory: t\nlaser: l\n";
  EXPECT_EQ(parseMissionFile(least, "mission.yaml").lasers.size(), 1U);
  EXPECT_EQ(complaintAbout("name: a\nrig: r\ntrajectory: t\n"), "mission.yaml, laser: is missing");
  EXPECT_EQ(complaintAbout("rig: r\ntrajectory: t\nlaser: l\n"), "mission.yaml, name: is missing");
  EXPECT_THAT(complaintAbout(least + "termal: x\n"),
              HasSubstr("mission.yaml: unknown key 'termal', expected one of"));
  EXPECT_THAT(complaintAbout(least + "ambient: warm\n"), HasSubstr("mission.yaml, ambient: found 'warm'"));
  EXPECT_EQ(complaintAbout(least + "humidity: 55\n"),
            "mission.yaml: Radiometry: humidity is 55, expected a fraction from 0 to 1");
  EXPECT_THAT(complaintAbout(least + "emissivity: 0\n"), HasSubstr("emissivity is 0, expected 0.05 to 1"));
  EXPECT_THAT(complaintAbout(least + "ambient: -300\n"), HasSubstr("atmosphere temperature is -300"));
  EXPECT_THAT(complaintAbout(least + "pose_sigma: 0.1\n"),
              HasSubstr("pose_sigma: found '0.1', expected a mapping"));
  EXPECT_THAT(complaintAbout(least + "pose_sigma: {rotation: -1}\n"),
              HasSubstr("pose_sigma.rotation: is -1"));
  EXPECT_THAT(complaintAbout(least + "camera_time_offset: 1e12\n"),
              HasSubstr("camera_time_offset: is 1e+12 s"));
  EXPECT_THAT(complaintAbout("name: a/b\n"),
              HasSubstr("name: found 'a/b', expected printable UTF-8 without '/'"));
  EXPECT_THAT(complaintAbout("name: [a]\n"), HasSubstr("name: found a list, expected a text"));
}

struct Recorded {
  const char* name;
  std::size_t readings;
  std::size_t points;  ///< returns and dropped ones together
  std::size_t frames;
};

class RecordedMission : public testing::TestWithParam<Recorded> {};

TEST_P(RecordedMission, IsReadToItsEnd) {
  THERMOVOX_NEEDS_RECORDINGS();
  const OpenedMission opened = openMission(*test::recordings() / "missions" / GetParam().name);
  EXPECT_EQ(opened.mission.name, GetParam().name);
  std::size_t readings = 0;
  std::size_t points = 0;
  std::optional<Time> previous;
  while (const auto reading = opened.readings->next()) {
    ++readings;
    points += reading->returns.size() + reading->dropped.total();
    EXPECT_TRUE(!previous || *previous < reading->stamp);
    previous = reading->stamp;
  }
  std::size_t frames = 0;
  while (opened.frames && opened.frames->next()) ++frames;
  EXPECT_EQ(readings, GetParam().readings);
  EXPECT_EQ(points, GetParam().points);
  EXPECT_EQ(frames, GetParam().frames);
}

INSTANTIATE_TEST_SUITE_P(All, RecordedMission,
                         testing::Values(Recorded{"hall-beam", 600, 600, 30},
                                         Recorded{"hall-scan", 120, 129720, 30},
                                         Recorded{"hall-cloud", 60, 491520, 30},
                                         Recorded{"intel", 906, 163080, 0},
                                         Recorded{"jhu-board", 8, 341609, 8}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace thermovox
