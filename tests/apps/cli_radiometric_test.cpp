// Missions of radiometric frames, as the program shows and maps them.
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

using testing::HasSubstr;
using namespace std::string_literals;
namespace fs = std::filesystem;

/// The same flight before a camera that sees no air, and before a radiometric one in hot and humid air.
class RadiometricFrames : public testing::Test {
 protected:
  RadiometricFrames() {
    simulate::SimulationOptions options;
    options.laser = LaserKind::cloud;
    options.seed = 11;
    options.duration = 0.8;
    options.supersampling = 1;
    options.air = 60.0;
    options.humidity = 0.9;
    simulate::simulateMission(options, folder / "clear");
    options.frames = simulate::FrameFormat::rjpeg;
    simulate::simulateMission(options, folder / "humid");
  }
  /// Draws a mission with fixed colours and gives its second picture back.
  [[nodiscard]] cv::Mat overlay(const std::string& arguments, const std::string& out) const {
    const Outcome outcome =
        thermovox(folder.path(), "overlay " + arguments + " " + out + " --span 15 40 --force");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return cv::imread((folder / out / "frame_000001.png").string());
  }

  TestFolder folder;
};

/// Mean difference of the thermal image in two overlays, of 3 x 255.
double difference(const cv::Mat& a, const cv::Mat& b) {
  EXPECT_EQ(a.size(), b.size());
  constexpr int kHeader = 56, kHeight = 960;
  const cv::Rect image(0, kHeader, a.cols, kHeight);
  cv::Mat differences;
  cv::absdiff(a(image), b(image), differences);
  const cv::Scalar sum = cv::mean(differences);
  return sum[0] + sum[1] + sum[2];
}

TEST_F(RadiometricFrames, AreShownThroughTheAirThatTheirPointsAreReadThrough) {
  const cv::Mat clear = overlay("clear", "a");
  const cv::Mat humid = overlay("humid", "b");
  const cv::Mat wrong = overlay("humid --atmosphere-temperature -40", "c");
  // It is 2.1, mostly where no laser point is near and along edges; without the air in the picture it was 43.
  EXPECT_LT(difference(clear, humid), 4.0);
  EXPECT_GT(difference(clear, wrong), 10.0 * difference(clear, humid)) << "so the picture has air in it";
}

TEST_F(RadiometricFrames, TakeTheOptionsOfMapInOverlay) {
  (void)overlay("humid", "a");
  (void)overlay("humid --emissivity 0.7 --reflected -40", "b");
  EXPECT_NE(bytesOf(folder / "a/overlay.csv"), bytesOf(folder / "b/overlay.csv"));
  EXPECT_EQ(thermovox(folder.path(), "overlay humid x --emissivity 7").code, 2);
  expectRefused(folder.path(), "overlay clear x --emissivity 0.7", {"camera's own making"});
}

TEST_F(RadiometricFrames, OutsideTheCalibratedRangeAreCountedAndToldOf) {
  for (const auto& entry : fs::directory_iterator(folder / "humid/thermal"))  // 550 K becomes 22 C
    replaceIn(entry.path(), "\x00\x80\x09\x44\x00\x00\x66\x43"s, "\x33\x93\x93\x43\x00\x00\x66\x43"s);
  const Outcome outcome = thermovox(folder.path(), "map humid --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  const auto outside = json.at("outside_calibration").get<std::size_t>();
  EXPECT_GT(outside, 100U);
  EXPECT_LT(outside, json.at("coloured").get<std::size_t>());
  EXPECT_THAT(outcome.err, HasSubstr(fmt::format("mission humid: {} of its {} coloured points", outside,
                                                 json.at("coloured").get<std::size_t>())));
  EXPECT_THAT(thermovox(folder.path(), "overlay humid x").err, HasSubstr("is calibrated for"));
  const Outcome clear = thermovox(folder.path(), "map clear --json");
  EXPECT_EQ(clear.json().at("outside_calibration"), 0);
  EXPECT_EQ(clear.err, "");
}

}  // namespace
}  // namespace thermovox::test
