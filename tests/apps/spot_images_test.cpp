#include "io/spot_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "projection/error.hpp"
#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;

/// A hall flown with both cameras, and mapped.
class SpotImagesOfAHall : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TestFolder>();
    simulate::SimulationOptions options;
    options.laser = LaserKind::cloud;
    options.seed = 5;
    options.duration = 1.0;
    options.flight = simulate::FlightStyle::facing_rows;
    options.supersampling = 1;
    options.visible = simulate::SimulationOptions::VisibleCamera::present;
    simulate::simulateMission(options, *folder_ / "hall");
    ASSERT_EQ(thermovox(folder_->path(), "map hall --station s.tvx").code, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  [[nodiscard]] static StationHotspots found() {
    return stationHotspots(Station::open(*folder_ / "s.tvx"), HotspotCriteria{});
  }
  static std::unique_ptr<TestFolder> folder_;
};

std::unique_ptr<TestFolder> SpotImagesOfAHall::folder_;

/// Brightness of a picture's bytes.
cv::Mat greyOf(const std::string& bytes) {
  const std::vector<char> encoded(bytes.begin(), bytes.end());
  return cv::imdecode(encoded, cv::IMREAD_GRAYSCALE);
}

TEST_F(SpotImagesOfAHall, ShowEachSpotWhereItIsHottestAndAsMuchOfIt) {
  const StationHotspots spots = found();
  OpenedMission opened = openMission(*folder_ / "hall");
  const SpotImagesById images = cutSpotImages(spots, opened);
  ASSERT_GE(images.size(), 1U);
  for (const auto& [id, image] : images) {
    SCOPED_TRACE(id);
    ASSERT_TRUE(image.thermal);
    const FrameCrop& crop = *image.thermal;
    const cv::Mat grey = greyOf(crop.bytes);
    ASSERT_EQ(grey.size(), cv::Size(crop.width_px, crop.height_px));
    // Inferno grows brighter with the temperature: at the spot it is about as bright as anywhere in the crop.
    double brightest = 0.0;
    cv::minMaxLoc(grey, nullptr, &brightest);
    const cv::Rect all({}, grey.size());
    const int px = static_cast<int>(crop.spot_px.x()), py = static_cast<int>(crop.spot_px.y());
    ASSERT_TRUE(all.contains({px, py}));
    double here = 0.0;
    cv::minMaxLoc(grey(cv::Rect(px - 10, py - 10, 21, 21) & all), nullptr, &here);
    EXPECT_GT(here, 0.85 * brightest);
    ASSERT_TRUE(crop.scale);
    const Hotspot& spot = *spots.history.tracks().at(static_cast<std::size_t>(id - 1)).seen[0];
    EXPECT_LT(std::abs(crop.scale->span.high - spot.peak.value), 0.25 * spot.delta.value);
    EXPECT_EQ(crop.stamp, spot.best_frame->stamp);
    EXPECT_THAT(crop.name, testing::StartsWith("thermal/"));
  }
  // As much of the surroundings in the visible picture.
  std::size_t visible = 0;
  for (const auto& [id, image] : images) {
    if (!image.visible) continue;
    ++visible;
    EXPECT_EQ(image.visible->stamp, image.thermal->stamp);
    EXPECT_EQ(std::max(image.visible->width_px, image.visible->height_px), 320);
    EXPECT_TRUE(image.visible->bytes.starts_with("\xFF\xD8"));
    EXPECT_FALSE(image.visible->scale);
    const Camera& camera = opened.mission.rig.visible_camera->camera;
    EXPECT_TRUE(image.visible->pixel.x() > -0.5 && image.visible->pixel.x() < camera.width() - 0.5);
  }
  EXPECT_GE(visible, 1U);
}

TEST_F(SpotImagesOfAHall, StandInTheReportAndAreOfMissionsOfTheStation) {
  const StationHotspots spots = found();
  const fs::path other = *folder_ / "other";
  fs::copy(*folder_ / "hall", other, fs::copy_options::recursive);
  // A list that ends before the spots were seen.
  folder_->write("other/thermal.csv", "timestamp,file\n1760000000.013,thermal/000000.tiff\n");
  OpenedMission cut = openMission(other);
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(cutSpotImages(spots, cut)); }),
              testing::AllOf(testing::HasSubstr("thermal.csv"), testing::HasSubstr("has no frame at")));
  cut.mission.name = "elsewhere";
  EXPECT_THAT(messageOf<DataError>([&] { static_cast<void>(cutSpotImages(spots, cut)); }),
              testing::AllOf(testing::HasSubstr("found mission elsewhere"), testing::HasSubstr("hall")));
  fs::remove_all(other);

  const Outcome made = thermovox(folder_->path(), "report s.tvx a.html --images hall");
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string html = bytesOf(*folder_ / "a.html");
  EXPECT_THAT(html, testing::HasSubstr("data:image/jpeg;base64,"));
  EXPECT_THAT(html, testing::HasSubstr("The thermal camera's"));
  EXPECT_THAT(html, testing::HasSubstr("The visible camera's"));
  EXPECT_EQ(thermovox(folder_->path(), "report s.tvx b.html --images hall").code, 0);
  EXPECT_EQ(html, bytesOf(*folder_ / "b.html"));
  EXPECT_EQ(thermovox(folder_->path(), "report s.tvx c.html --images hall --images hall").code, 2);
}

}  // namespace
}  // namespace thermovox::test
