#include "io/overlay_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 80, kHeight = 60, kZoom = 8;

/// An image of one temperature: whatever differs from its colour was drawn.
ThermalImage evenImage() {
  return {.width = kWidth,
          .height = kHeight,
          .celsius = std::vector<float>(static_cast<std::size_t>(kWidth * kHeight), 20.0F)};
}

cv::Mat draw(const std::vector<OverlayPoint>& points, const ThermalImage& image = evenImage()) {
  const test::TestFolder folder;
  OverlayOptions options{.title = "hall", .span = TemperatureSpan{0.0, 40.0}};
  options.width_px = kWidth * kZoom;
  writeOverlayPicture(folder / "picture.png", image, points, options, Existing::refuse);
  return cv::imread((folder / "picture.png").string());
}

/// Pixels of the picture, within the image's area, that differ between two pictures.
std::vector<cv::Point> differences(const cv::Mat& a, const cv::Mat& b, const cv::Rect& area) {
  std::vector<cv::Point> places;
  for (int y = area.y; y < area.br().y; ++y) {
    for (int x = area.x; x < area.br().x; ++x) {
      if (a.at<cv::Vec3b>(y, x) != b.at<cv::Vec3b>(y, x)) places.emplace_back(x, y);
    }
  }
  return places;
}

/// Where the image lies in the picture: the one rectangle of its colour.
cv::Rect imageArea(const cv::Mat& picture) {
  const int column = picture.cols / 2;
  const cv::Vec3b colour = picture.at<cv::Vec3b>(picture.rows / 2, column);
  int top = picture.rows / 2, bottom = top;
  while (top > 0 && picture.at<cv::Vec3b>(top - 1, column) == colour) --top;
  while (bottom + 1 < picture.rows && picture.at<cv::Vec3b>(bottom + 1, column) == colour) ++bottom;
  return {0, top, picture.cols, bottom + 1 - top};
}

TEST(OverlayPicture, MarksWhatTheCameraIsNotCalibratedFor) {
  ThermalImage image = evenImage();
  image.celsius[10 * kWidth + 30] = 300.0F;
  image.calibrated_range = CalibratedRange{-20.0, 120.0};
  const cv::Mat picture = draw({}, image);
  const int rows = draw({}).rows;
  EXPECT_GT(picture.rows, rows) << "and explains it";
  const Rgb above = uncalibratedColours(Palette::inferno).above;
  EXPECT_EQ(picture.at<cv::Vec3b>(56 + 10 * kZoom + 3, 30 * kZoom + 3), cv::Vec3b(above.b, above.g, above.r));
}

TEST(OverlayPicture, ShowsTheImageEnlargedByAWholeFactor) {
  const cv::Mat picture = draw({});
  ASSERT_EQ(picture.cols, kWidth * kZoom);
  EXPECT_EQ(imageArea(picture).height, kHeight * kZoom);
  const Rgb expected = colourOf(20.0, {0.0, 40.0}, Palette::inferno);
  EXPECT_EQ(picture.at<cv::Vec3b>(picture.rows / 2, picture.cols / 2),
            cv::Vec3b(expected.b, expected.g, expected.r));
}

TEST(OverlayPicture, ADotLiesWhereItsPixelSays) {
  const cv::Mat plain = draw({{.pixel = {-100.0, -100.0}, .range = 3.0}});
  const cv::Rect area = imageArea(draw({}));
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(10.0, 20.0), Eigen::Vector2d(60.25, 41.5)}) {
    const auto drawn = differences(draw({{.pixel = pixel, .range = 3.0}}), plain, area);
    ASSERT_GT(drawn.size(), 10U);
    cv::Point2d sum(0.0, 0.0);
    for (const cv::Point& place : drawn) sum += cv::Point2d(place) / static_cast<double>(drawn.size());
    // The centre of pixel (0, 0) of the image is the middle of its first kZoom x kZoom pixels.
    EXPECT_NEAR(sum.x, area.x + (pixel.x() + 0.5) * kZoom, 0.75);
    EXPECT_NEAR(sum.y, area.y + (pixel.y() + 0.5) * kZoom, 0.75);
    EXPECT_LT(drawn.size(), 150U);  // a dot and no more
  }
}

TEST(OverlayPicture, NearAndFarDotsHaveTheColoursOfTheirDistances) {
  const cv::Mat picture =
      draw({{.pixel = {20.0, 30.0}, .range = 2.0}, {.pixel = {60.0, 30.0}, .range = 9.0}});
  const cv::Rect area = imageArea(draw({}));
  const auto colourIn = [&](double u) {
    return picture.at<cv::Vec3b>(area.y + static_cast<int>(30.5 * kZoom),
                                 static_cast<int>((u + 0.5) * kZoom));
  };
  const Rgb near = colourAt(Palette::rainbow, 0.0);
  const Rgb far = colourAt(Palette::rainbow, 1.0);
  EXPECT_EQ(colourIn(20.0), cv::Vec3b(near.b, near.g, near.r));
  EXPECT_EQ(colourIn(60.0), cv::Vec3b(far.b, far.g, far.r));
}

TEST(OverlayPicture, ChosenPointsAreLabelledBesideThem) {
  OverlayPoint chosen{.pixel = {20.0, 30.0}, .range = 4.2, .celsius = 55.5};
  const cv::Mat plain = draw({chosen});
  const cv::Rect area = imageArea(draw({}));
  chosen.label = "centre";
  const cv::Mat labelled = draw({chosen});
  const auto plate = differences(labelled, plain, area);
  ASSERT_GT(plate.size(), 2000U);
  int bright = 0;
  for (const cv::Point& place : plate) bright += labelled.at<cv::Vec3b>(place)[1] > 200;
  EXPECT_GT(bright, 200);  // the letters
  chosen.label = "right";
  EXPECT_FALSE(differences(draw({chosen}), labelled, area).empty());
}

TEST(OverlayPicture, LabelsNearTheRimStayInsideTheImage) {
  const cv::Rect area = imageArea(draw({}));
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(79.0, 0.0),
                                       Eigen::Vector2d(0.0, 59.0), Eigen::Vector2d(79.0, 59.0)}) {
    OverlayPoint point{.pixel = pixel, .range = 4.2, .celsius = 55.5};
    const cv::Mat plain = draw({point});
    point.label = "hottest";
    const cv::Mat labelled = draw({point});
    const cv::Rect below(0, area.br().y + 14, area.width, labelled.rows - area.br().y - 14);
    EXPECT_TRUE(differences(labelled, plain, below).empty());
    EXPECT_GT(differences(labelled, plain, area).size(), 2000U);
  }
}

TEST(OverlayPicture, PixelsThatAreNotKnownAreGreyAndNoPointIsNoReasonToFail) {
  ThermalImage image = evenImage();
  image.celsius.assign(image.celsius.size(), std::nanf(""));
  const cv::Mat picture = draw({}, image);
  EXPECT_EQ(picture.at<cv::Vec3b>(picture.rows / 2, picture.cols / 2),
            cv::Vec3b(kUnknownColour.b, kUnknownColour.g, kUnknownColour.r));
}

TEST(OverlayPicture, RefusesAnExistingFileAndLeavesNothingElse) {
  const test::TestFolder folder;
  const fs::path file = folder.write("picture.png", "precious");
  EXPECT_THAT(
      test::messageOf<DataError>([&] { writeOverlayPicture(file, evenImage(), {}, {}, Existing::refuse); }),
      testing::HasSubstr("picture.png: exists already"));
  EXPECT_EQ(test::bytesOf(file), "precious");
  writeOverlayPicture(file, evenImage(), {}, {}, Existing::replace);
  EXPECT_EQ(test::bytesOf(file).substr(1, 3), "PNG");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace thermovox
