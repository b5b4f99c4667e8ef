#include "io/map_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <vector>

#include "io/picture_canvas.hpp"
#include "io/splat_view.hpp"
#include "io/surface_normals.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

/// A room of 8 x 5 x 3 m: floor at 20 C, walls at 22 C, ceiling without temperature, a hot spot on the floor.
std::vector<SurfacePoint> room() {
  std::vector<SurfacePoint> points;
  const auto add = [&points](double x, double y, double z, std::optional<float> celsius) {
    SurfacePoint point{{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, std::nullopt};
    if (celsius) point.temperature = SurfaceTemperature{*celsius, 0.05F, 3, 1.7e9};
    points.push_back(point);
  };
  for (double x = 0.0; x <= 8.0; x += 0.1) {
    for (double y = 0.0; y <= 5.0; y += 0.1) {
      const bool hot = std::hypot(x - 6.0, y - 2.5) < 0.4;
      add(x, y, 0.0, hot ? 80.0F : 20.0F);
      add(x, y, 3.0, std::nullopt);
    }
    for (double z = 0.0; z <= 3.0; z += 0.1) add(x, 5.0, z, 22.0F);
  }
  return points;
}

MapPictureOptions smallPicture() {
  MapPictureOptions options;
  options.title = "room";
  options.resolution = 0.1;
  options.width_px = 640;
  options.height_px = 360;
  return options;
}

std::size_t countPixels(const cv::Mat& picture, const auto& matches) {
  return static_cast<std::size_t>(std::count_if(picture.begin<cv::Vec3b>(), picture.end<cv::Vec3b>(),
                                                [&](const cv::Vec3b& p) { return matches(p); }));
}

bool isHot(const cv::Vec3b& bgr) {
  return bgr[2] > 170 && bgr[1] > 140 && bgr[0] + 30 < bgr[2];
}

TEST(MapPicture, ShowsTheHotSpotOnlyInTheHalfByTemperature) {
  const test::TestFolder folder;
  MapPictureOptions options = smallPicture();
  writeMapPicture(folder / "split.png", room(), options, Existing::refuse);
  options.style = PictureStyle::temperature;
  writeMapPicture(folder / "all.png", room(), options, Existing::refuse);
  const cv::Mat split = cv::imread(folder / "split.png");
  const cv::Mat all = cv::imread(folder / "all.png");
  ASSERT_EQ(split.size(), cv::Size(640, 360));
  const cv::Rect below_scale(0, 60, 640, 300);
  EXPECT_GT(countPixels(split(below_scale), isHot), 100U);  // the spot is in the half on the right
  EXPECT_GT(countPixels(all(below_scale), isHot), 100U);
  const auto is_grey = [](const cv::Vec3b& p) { return p[0] > 100 && std::abs(p[0] - p[2]) < 20; };
  const cv::Rect left(0, 60, 320, 300);
  EXPECT_GT(countPixels(split(left), is_grey), 10000U);
  EXPECT_LT(countPixels(all(left), is_grey), 100U);
}

TEST(MapPicture, SameMapGivesSameBytes) {
  const test::TestFolder folder;
  writeMapPicture(folder / "a.png", room(), smallPicture(), Existing::refuse);
  writeMapPicture(folder / "b.png", room(), smallPicture(), Existing::refuse);
  EXPECT_EQ(test::bytesOf(folder / "a.png"), test::bytesOf(folder / "b.png"));
}

TEST(MapPicture, MapWithoutTemperaturesIsDrawnWithoutAScale) {
  const test::TestFolder folder;
  std::vector<SurfacePoint> points = room();
  for (SurfacePoint& point : points) point.temperature.reset();
  writeMapPicture(folder / "a.png", points, smallPicture(), Existing::refuse);
  const cv::Mat picture = cv::imread(folder / "a.png");
  EXPECT_EQ(countPixels(picture, isHot), 0U);
}

TEST(MapPicture, RefusesWhatCannotBeDrawn) {
  const test::TestFolder folder;
  const auto draw = [&folder](const std::vector<SurfacePoint>& points, const MapPictureOptions& options) {
    writeMapPicture(folder / "a.png", points, options, Existing::refuse);
  };
  EXPECT_THAT(test::messageOf<DataError>([&] { draw({}, smallPicture()); }),
              testing::HasSubstr("no surface"));
  MapPictureOptions options = smallPicture();
  options.elevation_deg = 90.0;
  EXPECT_THAT(test::messageOf<ConfigError>([&] { draw(room(), options); }),
              testing::HasSubstr("elevation_deg"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
  folder.write("a.png", "kept");
  EXPECT_THROW(draw(room(), smallPicture()), DataError);
  EXPECT_EQ(test::bytesOf(folder / "a.png"), "kept");
}

TEST(MapPicture, OnePointIsEnough) {
  const test::TestFolder folder;
  const std::vector<SurfacePoint> one{{{1.0F, 2.0F, 3.0F}, SurfaceTemperature{30.0F, 0.1F, 1, 0.0}}};
  writeMapPicture(folder / "a.png", one, smallPicture(), Existing::refuse);
  EXPECT_EQ(cv::imread(folder / "a.png").size(), cv::Size(640, 360));
}

TEST(DrawSplats, NearestIsInFrontAndTheBackgroundStays) {
  PictureView view;
  view.width_px = 40;
  view.height_px = 40;
  view.center_x_px = 20.0;
  view.center_y_px = 20.0;
  view.focal_px = 40.0;
  const RgbPicture background{40, 40, std::vector<std::uint8_t>(4800, 7)};
  const Eigen::Vector3f facing(0.0F, 0.0F, -1.0F);
  const std::vector<Splat> splats{{{0.0F, 0.0F, 2.0F}, facing, 0.3F, {200, 0, 0}},
                                  {{0.0F, 0.0F, 4.0F}, facing, 1.0F, {0, 200, 0}},
                                  {{0.0F, 0.0F, -2.0F}, facing, 1.0F, {0, 0, 200}}};
  const RgbPicture picture = drawSplats(splats, view, background);
  const auto at = [&picture](int u, int v) {
    return &picture.rgb[static_cast<std::size_t>(3 * (v * 40 + u))];
  };
  EXPECT_GT(at(20, 20)[0], 100);  // the near one
  EXPECT_EQ(at(20, 20)[1], 0);
  EXPECT_EQ(at(28, 20)[0], 0);  // beside it the far one
  EXPECT_GT(at(28, 20)[1], 50);
  EXPECT_EQ(at(2, 2)[2], 7);
}

TEST(LocalSurfaces, NormalIsThatOfThePlaneAndUnknownForLonePoints) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  const Eigen::Vector3f normal = Eigen::Vector3f(1.0F, 2.0F, -0.5F).normalized();
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3f p(place(random), place(random), place(random));
    points.push_back(p - p.dot(normal) * normal);
  }
  points.emplace_back(9.0F, 9.0F, 9.0F);
  points.emplace_back(std::nanf(""), 0.0F, 0.0F);
  const std::vector<LocalSurface> surfaces = localSurfaces(points, 0.2);
  ASSERT_EQ(surfaces.size(), points.size());
  for (int i = 0; i < 3000; ++i) {
    if (surfaces[i].neighbours < 5) continue;
    EXPECT_NEAR(std::abs(surfaces[i].normal.dot(normal)), 1.0F, 1e-3F);
  }
  EXPECT_EQ(surfaces[3000].neighbours, 1);
  EXPECT_TRUE(surfaces[3000].normal.isZero());
  EXPECT_EQ(surfaces[3001].neighbours, 0);
}

TEST(RoundTicks, LieAtRoundTemperaturesWithinTheSpan) {
  EXPECT_THAT(roundTicks({19.7, 31.2}, 6), testing::ElementsAre(20, 22, 24, 26, 28, 30));
  EXPECT_THAT(roundTicks({-0.12, 0.11}, 4),
              testing::ElementsAre(testing::DoubleEq(-0.1), 0.0, testing::DoubleEq(0.1)));
  EXPECT_THAT(roundTicks({0.0, 500.0}, 5), testing::ElementsAre(0, 100, 200, 300, 400, 500));
}

}  // namespace
}  // namespace thermovox
