#include "io/thermal_picture.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

/// Warm on the left, cold on the right, one pixel not known.
ThermalImage twoHalves() {
  ThermalImage image{.width = 80, .height = 60, .celsius = std::vector<float>(80 * 60)};
  for (std::size_t i = 0; i < image.celsius.size(); ++i) image.celsius[i] = i % 80 < 40 ? 30.0F : 10.0F;
  return image;
}

void expectColour(const cv::Mat& picture, cv::Point place, const Rgb& colour, int tolerance) {
  const auto pixel = picture.at<cv::Vec3b>(place);
  EXPECT_NEAR(pixel[2], colour.r, tolerance);
  EXPECT_NEAR(pixel[1], colour.g, tolerance);
  EXPECT_NEAR(pixel[0], colour.b, tolerance);
}

TEST(WriteThermalPicture, PaintsByPaletteAndSpanAsPngOrJpeg) {
  const test::TestFolder folder;
  ThermalImage image = twoHalves();
  for (int v = 0; v < 10; ++v) {
    for (int u = 0; u < 10; ++u) image.celsius[static_cast<std::size_t>(80 * v + u)] = NAN;
  }
  for (const auto& [name, tolerance] : {std::pair("p.png", 0), std::pair("p.jpg", 6)}) {
    for (const Palette palette : {Palette::inferno, Palette::grey, Palette::ironbow}) {
      writeThermalPicture(folder / name, image, {palette, {0.0, 40.0}, ""}, Existing::replace);
      const cv::Mat picture = cv::imread((folder / name).string());
      ASSERT_EQ(picture.cols, 960) << "twelve times as large";
      expectColour(picture, {240, 500}, colourAt(palette, 0.75), tolerance);
      expectColour(picture, {700, 500}, colourAt(palette, 0.25), tolerance);
      expectColour(picture, {20, 20}, kUnknownColour, tolerance);
    }
  }
}

TEST(WriteThermalPicture, HasAScaleBelow) {
  const test::TestFolder folder;
  writeThermalPicture(folder / "p.png", twoHalves(), {Palette::grey, {0.0, 40.0}, "a note"},
                      Existing::refuse);
  const cv::Mat picture = cv::imread((folder / "p.png").string());
  ASSERT_GT(picture.rows, 720 + 60);
  const int row = 720 + 28;  // through the bar
  expectColour(picture, {70, row}, colourAt(Palette::grey, 0.0), 6);
  expectColour(picture, {picture.cols - 45, row}, colourAt(Palette::grey, 1.0), 6);
}

TEST(WriteThermalPicture, MarksAndExplainsWhatTheCameraIsNotCalibratedFor) {
  const test::TestFolder folder;
  ThermalImage image = twoHalves();
  image.celsius[80 * 30 + 20] = 130.0F;  // single pixels, twelve times as large
  image.celsius[80 * 30 + 60] = -40.0F;
  const auto drawn = [&] {
    writeThermalPicture(folder / "p.png", image, {Palette::grey, {0.0, 40.0}, "a note"}, Existing::replace);
    return cv::imread((folder / "p.png").string());
  };
  const cv::Mat plain = drawn();
  image.calibrated_range = CalibratedRange{-20.0, 120.0};
  const cv::Mat marked = drawn();
  const auto [below, above] = uncalibratedColours(Palette::grey);
  for (const int inside : {0, 6, 11}) {
    expectColour(marked, {12 * 20 + inside, 12 * 30 + inside}, above, 0);
    expectColour(marked, {12 * 60 + inside, 12 * 30 + inside}, below, 0);
  }
  expectColour(marked, {12 * 20, 500}, colourAt(Palette::grey, 0.75), 0);
  ASSERT_GT(marked.rows, plain.rows) << "a row of the legend for each";
  const int legend = plain.rows - 30;
  expectColour(marked, {26, legend + 10}, below, 0);
  expectColour(marked, {26, legend + 10 + (marked.rows - plain.rows) / 2}, above, 0);
  image.celsius.assign(image.celsius.size(), 20.0F);
  EXPECT_EQ(drawn().rows, plain.rows) << "nothing to explain";
}

TEST(CalibratedSpan, LeavesWhatTheCameraIsNotCalibratedForOutUnlessThereIsNothingElse) {
  ThermalImage image = twoHalves();
  for (std::size_t i = 0; i < 500; ++i) image.celsius[i] = -60.0F;
  EXPECT_EQ(calibratedSpan(image, 0.0, 100.0), (TemperatureSpan{-60.0, 30.0}));
  image.calibrated_range = CalibratedRange{-20.0, 120.0};
  EXPECT_EQ(calibratedSpan(image, 0.0, 100.0), (TemperatureSpan{10.0, 30.0}));
  image.calibrated_range = CalibratedRange{200.0, 300.0};
  EXPECT_EQ(calibratedSpan(image, 0.0, 100.0), (TemperatureSpan{-60.0, 30.0}));
  EXPECT_EQ(calibratedSpan({.width = 1, .height = 1, .celsius = {NAN}}, 0.0, 100.0), TemperatureSpan{});
}

TEST(WriteThermalPicture, TakesImagesOfAnySize) {
  const test::TestFolder folder;
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 2000), std::pair(1024, 3)}) {
    const ThermalImage image{.width = width,
                             .height = height,
                             .celsius = std::vector<float>(static_cast<std::size_t>(width * height), 20.0F)};
    writeThermalPicture(folder / "p.png", image, {Palette::inferno, {19.0, 21.0}, "x"}, Existing::replace);
    const cv::Mat picture = cv::imread((folder / "p.png").string());
    EXPECT_GE(picture.cols, width);
    EXPECT_GE(picture.rows, height);
  }
}

TEST(WriteThermalPicture, KeepsAPictureThatIsThere) {
  const test::TestFolder folder;
  folder.write("p.png", "mine");
  EXPECT_THROW(writeThermalPicture(folder / "p.png", twoHalves(), {}, Existing::refuse), DataError);
  EXPECT_EQ(test::bytesOf(folder / "p.png"), "mine");
}

}  // namespace
}  // namespace thermovox
