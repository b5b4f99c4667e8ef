#include "io/capture_folder.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "io/capture_laser.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::string_view kCaptures = R"(name: hall
captures: captures.csv
rig: rig.yaml
board: {pattern: chessboard, inner_corners: [9, 6], square: 0.04, margin: 0.02}
)";
constexpr std::string_view kRig = R"(laser:
  {kind: beam, range_min: 0.1, range_max: 40, range_sigma: 0.01,
   T_body_laser: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}}
)";

std::vector<CaptureFiles> listOf(const std::string& text) {
  return readCaptureList(std::make_unique<std::istringstream>(text), "captures.csv", "folder");
}

std::string complaintAbout(const std::string& text) {
  return messageOf<DataError>([&] { (void)listOf(text); });
}

TEST(CaptureList, NamesTheFilesOfEachCapture) {
  const auto captures = listOf("thermal,visible,laser\nt0.tiff,v0.jpg,b0.csv\n\nt1.tiff,,\n , v2.jpg ,\r\n");
  ASSERT_EQ(captures.size(), 3U);
  EXPECT_EQ(captures[0].name, "b0.csv");
  EXPECT_EQ(captures[0].thermal, "folder/t0.tiff");
  EXPECT_EQ(captures[0].visible, "folder/v0.jpg");
  EXPECT_EQ(captures[0].laser, "folder/b0.csv");
  EXPECT_EQ(captures[0].place, "captures.csv:2");
  EXPECT_EQ(captures[1].name, "t1.tiff");
  EXPECT_FALSE(captures[1].visible || captures[1].laser || captures[1].thermal_corners);
  EXPECT_EQ(captures[1].place, "captures.csv:4");
  EXPECT_EQ(captures[2].name, "v2.jpg");
}

TEST(CaptureList, TakesColumnsByItsHeaderOrInTheUsualOrder) {
  const auto headed = listOf("laser,visible_corners,visible\nb.csv,c.csv,v.jpg\n");
  ASSERT_EQ(headed.size(), 1U);
  EXPECT_EQ(headed[0].laser, "folder/b.csv");
  EXPECT_EQ(headed[0].visible, "folder/v.jpg");
  EXPECT_EQ(headed[0].visible_corners, "folder/c.csv");
  const auto plain = listOf("t.tiff,v.jpg,b.csv,tc.csv\n,w.jpg,,\n");
  ASSERT_EQ(plain.size(), 2U);
  EXPECT_EQ(plain[0].thermal, "folder/t.tiff");
  EXPECT_EQ(plain[0].thermal_corners, "folder/tc.csv");
  EXPECT_EQ(plain[1].visible, "folder/w.jpg");
}

TEST(CaptureList, RefusesRowsThatSayNothing) {
  EXPECT_EQ(complaintAbout("t,v,l\n,,\n"),
            "captures.csv:2: names no file, expected at least one of thermal, visible and laser");
  EXPECT_EQ(complaintAbout("thermal,visible,laser\n"), "captures.csv: lists no capture, expected one a row");
  EXPECT_EQ(complaintAbout(""), "captures.csv: lists no capture, expected one a row");
  EXPECT_THAT(complaintAbout("thermal,visible,laser,thermal_corners\n,v,b,c\n"),
              HasSubstr("captures.csv:2: names corners without their image"));
}

TEST(CaptureList, RefusesAFileThatIsNamedTwice) {
  EXPECT_EQ(complaintAbout("t,v,b\nu,,./b\n"),
            "captures.csv:2: names './b', which captures.csv:1 names too, expected each file once");
  EXPECT_THAT(complaintAbout("both,both,b\n"), HasSubstr("captures.csv:1 names too"));
}

TEST(CaptureList, RefusesRowsOfOtherColumns) {
  EXPECT_EQ(complaintAbout("thermal,visible,laser\nt,v\n"),
            "captures.csv:2: has 2 field(s), expected 3, one for each column");
  EXPECT_THAT(complaintAbout("t,v\n"),
              HasSubstr("captures.csv:1: has 2 field(s), expected thermal,visible,laser"));
  EXPECT_THAT(complaintAbout("1,2,3,4,5,6\n"), HasSubstr("captures.csv:1: has 6 field(s)"));
  EXPECT_THAT(complaintAbout("thermal,visible,lazer\n"), HasSubstr("captures.csv:1: unknown column 'lazer'"));
  EXPECT_THAT(complaintAbout("thermal,laser,laser\n"), HasSubstr("column 'laser' is given twice"));
  EXPECT_THAT(complaintAbout(std::string("t\0t,v,b\n", 8)), HasSubstr("the name of the file is damaged"));
}

TEST(ParseCapturesFile, RefusesWhatCapturesDoNotSay) {
  const auto complaint = [](std::string text) {
    return messageOf<ConfigError>([&] { (void)parseCapturesFile(text, "captures.yaml"); });
  };
  const std::string all(kCaptures);
  EXPECT_EQ(parseCapturesFile(all, "captures.yaml").board.columns, 9);
  EXPECT_THAT(complaint(all + "trajectory: t\n"), HasSubstr("captures.yaml: unknown key 'trajectory'"));
  EXPECT_THAT(complaint("name: a/b\n"), HasSubstr("captures.yaml, name: found 'a/b'"));
  EXPECT_EQ(complaint("name: a\nrig: r\n"), "captures.yaml, captures: is missing");
  EXPECT_EQ(complaint("name: a\ncaptures: c\nrig: r\n"), "captures.yaml, board: is missing");
  EXPECT_THAT(complaint("name: a\ncaptures: c\nrig: r\nboard: 3\n"), HasSubstr("board: found '3'"));
  for (std::size_t length = 0; length + 2 < all.size(); length += 7)
    EXPECT_THROW((void)parseCapturesFile(all.substr(0, length), "captures.yaml"), ConfigError) << length;
}

/// Two captures by a beam.
class CaptureFolderTest : public testing::Test {
 protected:
  CaptureFolderTest() {
    folder.write("captures.yaml", kCaptures);
    folder.write("rig.yaml", kRig);
    folder.write("captures.csv", "thermal,visible,laser\n0.tiff,0.jpg,0.csv\n,,1.csv\n");
    folder.write("0.tiff", "not opened yet");
    folder.write("0.jpg", "not opened yet");
    folder.write("0.csv", "timestamp,range\n1,5\n1.1,inf\n1.2,6\n");
    folder.write("1.csv", "1,50\n2,0\n");
  }
  [[nodiscard]] CaptureFolder open() const { return openCaptures(folder.path()); }
  template <typename Exception>
  std::string complaint() const {
    return messageOf<Exception>([this] { (void)open(); });
  }

  test::TestFolder folder;
};

TEST_F(CaptureFolderTest, OpensWithAllItSays) {
  for (const auto& path : {folder.path(), folder / "captures.yaml"}) {
    const CaptureFolder opened = openCaptures(path);
    EXPECT_EQ(opened.name, "hall");
    EXPECT_EQ(opened.board.rows, 6);
    EXPECT_EQ(opened.rig.lasers.size(), 1U);
    EXPECT_EQ(opened.rig_file, folder / "rig.yaml");
    EXPECT_EQ(opened.folder, folder.path());
    ASSERT_EQ(opened.captures.size(), 2U);
    EXPECT_EQ(opened.captures[0].thermal, folder / "0.tiff");
    EXPECT_EQ(opened.captures[1].name, "1.csv");
    EXPECT_EQ(opened.captures[1].place, (folder / "captures.csv").string() + ":3");
  }
}

TEST_F(CaptureFolderTest, NamesTheMissingFileAndWhoNamesIt) {
  EXPECT_THAT(messageOf<DataError>([&] { (void)openCaptures(folder / "elsewhere"); }),
              HasSubstr("elsewhere: no such captures, expected a folder with a captures.yaml"));
  for (const auto& [file, key] : {std::pair("rig.yaml", "rig"), std::pair("captures.csv", "captures")}) {
    const std::string content = test::bytesOf(folder / file);
    std::filesystem::remove(folder / file);
    EXPECT_THAT(complaint<DataError>(),
                HasSubstr(std::string(file) + " (named by " + (folder / "captures.yaml").string() + ", " +
                          key + "): no such file"));
    folder.write(file, content);
  }
  std::filesystem::remove(folder / "0.jpg");
  EXPECT_THAT(complaint<DataError>(),
              AllOf(HasSubstr("0.jpg (named by "), HasSubstr("captures.csv:2, visible): no such file")));
  const auto station = folder.write("hall.tvx", std::string("SQLite format 3\0", 16));
  EXPECT_THAT(messageOf<DataError>([&] { (void)openCaptures(station); }),
              HasSubstr("is a station, expected a captures folder"));
}

TEST_F(CaptureFolderTest, ReadsAllThatABeamRecorded) {
  const CaptureFolder opened = open();
  const auto readings = readCaptureLaser(opened.captures[0], opened.rig.lasers.front());
  ASSERT_EQ(readings.size(), 3U);
  EXPECT_EQ(readings[0].returns.at(0).range(), 5.0);
  EXPECT_TRUE(readings[1].returns.empty());
  EXPECT_EQ(readings[2].returns.at(0).range(), 6.0);
}

TEST_F(CaptureFolderTest, RefusesALaserFileWithoutAnyReturn) {
  const CaptureFolder opened = open();
  const Laser& beam = opened.rig.lasers.front();
  EXPECT_THAT(messageOf<DataError>([&] { (void)readCaptureLaser(opened.captures[1], beam); }),
              AllOf(HasSubstr("1.csv (named by "), HasSubstr("captures.csv:3, laser): has no return"),
                    HasSubstr("of a beam from 0.1 to 40 m")));
  folder.write("1.csv", "");
  EXPECT_THROW((void)readCaptureLaser(opened.captures[1], beam), DataError);
}

TEST_F(CaptureFolderTest, ReadsScansAndClouds) {
  CaptureFiles capture{.laser = folder / "1.csv", .place = "captures.csv:3"};
  Laser laser{.kind = LaserKind::scan};
  folder.write("1.csv", "1,4,inf,5\n2,4,6,7\n");
  auto readings = readCaptureLaser(capture, laser);
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0].returns.size(), 2U);
  laser.kind = LaserKind::cloud;
  EXPECT_THAT(messageOf<DataError>([&] { (void)readCaptureLaser(capture, laser); }), HasSubstr("1.csv"));
  capture.laser = folder.write("1.ply",
                               "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n1 2 3\nnan 0 0\n");
  readings = readCaptureLaser(capture, laser);
  ASSERT_EQ(readings.size(), 1U);
  ASSERT_EQ(readings[0].returns.size(), 1U);
  EXPECT_EQ(readings[0].returns[0].p_laser, Eigen::Vector3d(1.0, 2.0, 3.0));
  capture.laser.reset();
  EXPECT_TRUE(readCaptureLaser(capture, laser).empty());
}

TEST(RecordedCaptures, AreReadToTheirEnd) {
  THERMOVOX_NEEDS_RECORDINGS();
  struct Recorded {
    const char* name;
    std::size_t captures;
    bool thermal;
  };
  for (const Recorded& recorded : {Recorded{"acfr", 6, false}, Recorded{"board-beam", 12, true},
                                   Recorded{"board-scan", 12, true}, Recorded{"board-cloud", 12, true}}) {
    SCOPED_TRACE(recorded.name);
    const CaptureFolder opened = openCaptures(*test::recordings() / "captures" / recorded.name);
    EXPECT_EQ(opened.name, recorded.name);
    EXPECT_EQ(opened.captures.size(), recorded.captures);
    for (const CaptureFiles& capture : opened.captures) {
      EXPECT_EQ(capture.thermal.has_value(), recorded.thermal);
      EXPECT_TRUE(capture.visible && capture.laser);
      EXPECT_FALSE(readCaptureLaser(capture, opened.rig.lasers.at(0)).empty());
    }
  }
}

}  // namespace
}  // namespace thermovox
