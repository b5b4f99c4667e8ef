#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "io/rig_file.hpp"
#include "tests/apps/program.hpp"
#include "tests/io/flir_file.hpp"

namespace thermovox::test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// A second of a mission with a visible camera, coarsely sampled to be quick.
void flyWithVisibleCamera(const fs::path& mission) {
  simulate::SimulationOptions options;
  options.laser = LaserKind::cloud;
  options.seed = 11;
  options.duration = 0.8;
  options.supersampling = 1;
  options.visible = simulate::SimulationOptions::VisibleCamera::present;
  simulate::simulateMission(options, mission);
}

/// A rig without one of its cameras.
void writeRigWithout(const fs::path& file, const fs::path& whole, const char* camera) {
  Rig rig = readRig(whole);
  if (std::string(camera) == "visible") rig.visible_camera.reset();
  if (std::string(camera) == "thermal") rig.thermal_camera.reset();
  writeRig(file, rig);
}

std::string stripesAsJpeg(int width, int height) {
  cv::Mat picture(height, width, CV_8U, cv::Scalar(40));
  for (int u = 0; u < width; u += 40) picture.colRange(u, std::min(width, u + 20)).setTo(200);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes);
  return {bytes.begin(), bytes.end()};
}

TEST(VisibleEdges, AreDrawnIntoAnImageByTheRigAndTheRange) {
  const TestFolder folder;
  flyWithVisibleCamera(folder / "hall");
  const std::string image = "image hall/thermal/000001.tiff --celsius-per-count 0.01 ";
  const std::string edges = "--visible hall/visible/000001.jpg --rig hall/rig.yaml ";
  for (const std::string& arguments :
       {image + "plain.png", image + "near.png --range 2 " + edges, image + "far.png --range 20 " + edges}) {
    const Outcome outcome = thermovox(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_NE(bytesOf(folder / "plain.png"), bytesOf(folder / "near.png"));
  EXPECT_NE(bytesOf(folder / "near.png"), bytesOf(folder / "far.png"));
}

TEST(VisibleEdges, OfAnImageNeedAFittingRigAndPicture) {
  const TestFolder folder;
  flyWithVisibleCamera(folder / "hall");
  writeRigWithout(folder / "thermal_only.yaml", folder / "hall/rig.yaml", "visible");
  writeRigWithout(folder / "visible_only.yaml", folder / "hall/rig.yaml", "thermal");
  folder.write("small.jpg", stripesAsJpeg(60, 40));
  folder.write("cut.jpg", bytesOf(folder / "hall/visible/000001.jpg").substr(0, 5000));
  const std::string image = "image hall/thermal/000001.tiff x.png --celsius-per-count 0.01 ";
  const std::string good_visible = "--visible hall/visible/000001.jpg ";
  const std::string good_rig = "--range 3 --rig hall/rig.yaml ";
  const auto refused = [&](const std::string& arguments, const std::vector<std::string>& words) {
    expectRefused(folder.path(), image + arguments, words);
  };
  refused(good_visible + "--range 3 --rig thermal_only.yaml", {"thermal_only.yaml: has no visible_camera"});
  refused(good_visible + "--range 3 --rig visible_only.yaml", {"visible_only.yaml: has no thermal_camera"});
  refused(good_visible + "--range 3 --rig no.yaml", {"no.yaml"});
  refused(good_rig + "--visible no.jpg", {"no.jpg"});
  refused(good_rig + "--visible small.jpg", {"small.jpg: is 60 x 40", "640 x 480"});
  refused(good_rig + "--visible cut.jpg", {"cut.jpg: is cut off"});
  refused(good_rig + "--visible hall/rig.yaml", {"rig.yaml", "neither a JPEG nor a PNG"});
  refused(good_visible + "--range 0.02 --rig hall/rig.yaml", {"000001.tiff", "look the same way"});
}

TEST(VisibleEdges, OfAnImageAreWrongUsageWithoutAllThatTheyNeed) {
  const TestFolder folder;
  for (const char* arguments :
       {"a.jpg x.png --visible v.jpg", "a.jpg x.png --visible v.jpg --rig r.yaml", "a.jpg x.png --range 3",
        "a.jpg x.png --edges --visible v.jpg --rig r.yaml --range 3", "a.jpg x.tiff --edges",
        "a.jpg x.tiff --visible v.jpg --rig r.yaml --range 3",
        "a.jpg x.png --visible v.jpg --rig r.yaml --range 0"})
    EXPECT_EQ(thermovox(folder.path(), std::string("image ") + arguments).code, 2) << arguments;
}

TEST(VisibleEdges, OfAFlirFileAreThoseOfItsOwnPicture) {
  const TestFolder folder;
  FlirFile file{.width = 40, .height = 30, .counts = calmCounts(40, 30), .parameters = e40()};
  folder.write("without.jpg", radiometricJpeg(flirFrame(file)));
  file.visible_jpeg = stripesAsJpeg(320, 240);
  folder.write("no_record.jpg", radiometricJpeg(flirFrame(file)));
  file.picture_in_picture = true;
  folder.write("a.jpg", radiometricJpeg(flirFrame(file)));
  EXPECT_EQ(thermovox(folder.path(), "image a.jpg plain.png").code, 0);
  const Outcome outcome = thermovox(folder.path(), "image a.jpg edges.png --edges");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(bytesOf(folder / "plain.png"), bytesOf(folder / "edges.png"));
  expectRefused(folder.path(), "image without.jpg x.png --edges", {"without.jpg: holds no visible picture"});
  expectRefused(folder.path(), "image no_record.jpg x.png --edges",
                {"no_record.jpg: holds no record of where its visible picture lies"});
}

TEST(VisibleEdges, AreDrawnIntoTheOverlaysOfAMission) {
  const TestFolder folder;
  flyWithVisibleCamera(folder / "hall");
  const Outcome edges = thermovox(folder.path(), "overlay hall edges");
  EXPECT_EQ(edges.code, 0) << edges.err;
  EXPECT_THAT(edges.out, HasSubstr("4 pictures, 4 with the edges of a visible one"));
  const Outcome plain = thermovox(folder.path(), "overlay hall plain --no-edges");
  EXPECT_THAT(plain.out, HasSubstr("plain: 4 pictures, chosen points"));
  EXPECT_NE(bytesOf(folder / "edges/frame_000001.png"), bytesOf(folder / "plain/frame_000001.png"));
  EXPECT_EQ(bytesOf(folder / "edges/overlay.csv"), bytesOf(folder / "plain/overlay.csv"));
}

TEST(VisibleEdges, OfAMissionAreLeftOutWhereNoPictureIsNearOrNoCameraInTheRig) {
  const TestFolder folder;
  flyWithVisibleCamera(folder / "hall");
  const std::string list = bytesOf(folder / "hall/visible.csv");
  folder.write("hall/visible.csv", list.substr(0, list.find('\n', list.find('\n') + 1) + 1));
  EXPECT_THAT(thermovox(folder.path(), "overlay hall sparse").out, HasSubstr("4 pictures, 2 with the edges"));
  writeRigWithout(folder / "hall/rig.yaml", folder / "hall/rig.yaml", "visible");
  const Outcome outcome = thermovox(folder.path(), "overlay hall none");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("4 pictures, chosen"));
  EXPECT_THAT(outcome.err, HasSubstr("rig.yaml: has no visible_camera"));
}

TEST(VisibleEdges, OfAMissionWithADamagedPictureLeaveNoFolder) {
  const TestFolder folder;
  flyWithVisibleCamera(folder / "hall");
  truncateTo(folder / "hall/visible/000002.jpg", 0.5);
  expectRefused(folder.path(), "overlay hall pictures", {"000002.jpg: is cut off"});
  fs::remove(folder / "hall/visible/000002.jpg");
  expectRefused(folder.path(), "overlay hall pictures", {"000002.jpg", "visible.csv:4"});
}

TEST(SimulatedVisibleCamera, LeavesAllElseOfTheMissionAsItIs) {
  const TestFolder folder;
  for (const std::string& name : {std::string("with"), std::string("without")}) {
    fs::create_directory(folder / name);
    const std::string camera = name == "with" ? " --visible" : "";
    ASSERT_EQ(thermovox(folder / name, "simulate hall --laser beam --duration 0.4" + camera).code, 0);
  }
  for (const std::string& name : namesUnder(folder / "without")) {
    if (fs::is_directory(folder / "without" / name)) continue;
    if (name == "hall/rig.yaml" || name == "hall/mission.yaml") continue;
    EXPECT_EQ(bytesOf(folder / "without" / name), bytesOf(folder / "with" / name)) << name;
  }
  EXPECT_TRUE(fs::exists(folder / "with/hall/visible/000001.jpg"));
  EXPECT_FALSE(fs::exists(folder / "without/hall/visible.csv"));
}

}  // namespace
}  // namespace thermovox::test
