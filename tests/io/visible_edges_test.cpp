#include "io/visible_edges.hpp"

#include <gtest/gtest.h>

#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

/// A picture whose pixel (u, v) has the brightness value(u, v).
template <typename Value>
VisiblePicture pictureOf(int width, int height, Value&& value) {
  VisiblePicture picture{.width = width, .height = height};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) picture.luminance.push_back(static_cast<std::uint8_t>(value(u, v)));
  }
  return picture;
}

/// Pixel (u, v) lies at scale * (u, v) + shift.
PixelMap scaledMap(int width, int height, double scale, const Eigen::Vector2d& shift) {
  PixelMap map{.width = width, .height = height};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) map.pixels.emplace_back(scale * Eigen::Vector2d(u, v) + shift);
  }
  return map;
}

// The camera's inset is visible width / Real2IR wide; its middle is the visible picture's, moved by the
// offsets. Corners of pixels, not centres, coincide: -0.5 is the left edge of the first one.
TEST(PixelsByRecord, LieInTheInsetOfTheVisiblePicture) {
  const RawThermalImage thermal{.width = 80, .height = 60};
  const VisiblePicture visible = pictureOf(640, 480, [](int, int) { return 0; });
  const PictureInPicture record{.real_to_ir = 1.6, .offset_x = 10, .offset_y = -20};
  const PixelMap map = pixelsByRecord(record, thermal, visible);
  EXPECT_THAT(map.at({39.5, 29.5}), IsNear(Eigen::Vector2d(329.5, 219.5), 1e-9));
  EXPECT_THAT(map.at({-0.5, 29.5}), IsNear(Eigen::Vector2d(129.5, 219.5), 1e-9)) << "400 visible px wide";
  EXPECT_THAT(map.at({39.5, 59.5}), IsNear(Eigen::Vector2d(329.5, 369.5), 1e-9)) << "5 of them a pixel";
}

TEST(Resample, TakesTheBrightnessFromItsPlace) {
  const VisiblePicture ramp = pictureOf(100, 80, [](int u, int v) { return u + v; });
  const ResampledPicture resampled = resample({ramp, scaledMap(20, 16, 4.0, {2.0, 3.0})}, 2);
  ASSERT_EQ(resampled.width, 40);
  ASSERT_EQ(resampled.height, 32);
  for (int y = 2; y < 30; ++y) {
    for (int x = 2; x < 38; ++x) {
      const double u = 4.0 * ((x + 0.5) / 2 - 0.5) + 2.0, v = 4.0 * ((y + 0.5) / 2 - 0.5) + 3.0;
      // One for rounding and half of one for the smoothing.
      EXPECT_NEAR(resampled.luminance[static_cast<std::size_t>(40 * y + x)], u + v, 1.5) << x << ", " << y;
    }
  }
}

TEST(Resample, MarksWhatTheVisiblePictureCovers) {
  const VisiblePicture even = pictureOf(10, 10, [](int, int) { return 100; });
  PixelMap map = scaledMap(20, 10, 1.0, {-5.0, 0.0});
  map.pixels[20 * 5 + 9] = Eigen::Vector2d::Constant(std::nan(""));
  const ResampledPicture resampled = resample({even, map}, 1);
  for (int x = 0; x < 20; ++x) {
    EXPECT_EQ(resampled.covered[static_cast<std::size_t>(20 * 2 + x)], x >= 5 && x < 15 ? 255 : 0) << x;
  }
  EXPECT_EQ(resampled.covered[20 * 5 + 9], 0);
}

TEST(Resample, OfAFinerPictureMissesNoStripes) {
  const VisiblePicture stripes = pictureOf(400, 400, [](int u, int) { return u % 2 == 0 ? 0 : 200; });
  const ResampledPicture resampled = resample({stripes, scaledMap(50, 50, 8.0, {3.5, 3.5})}, 1);
  for (const std::uint8_t luminance : resampled.luminance) EXPECT_NEAR(luminance, 100, 2);
}

TEST(Resample, OfAPictureTooSmallToInterpolateCoversNothing) {
  const VisiblePicture dot = pictureOf(1, 1, [](int, int) { return 100; });
  const ResampledPicture resampled = resample({dot, scaledMap(4, 4, 1.0, {0.0, 0.0})}, 2);
  EXPECT_EQ(resampled.covered, std::vector<std::uint8_t>(64, 0));
}

}  // namespace
}  // namespace thermovox::test
