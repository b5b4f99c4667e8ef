#include "projection/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/projection/matchers.hpp"
#include "tests/projection/random_cameras.hpp"

namespace thermovox::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A thermal camera beside a visible one that is turned a little and has a lens of its own.
struct Pair {
  Camera thermal{intrinsicsOf(LensModel::brown_conrady, {-0.23, 0.08, -0.001, 0.001, 0.0}, 160, 120)};
  Camera visible{intrinsicsOf(LensModel::kannala_brandt, {0.03, -0.01, 0.004, -0.001}, 640, 480)};
  Pose T_visible_thermal{expRotation({0.02, -0.03, 0.05}), {0.06, -0.02, 0.01}};

  [[nodiscard]] CameraPair cameras() const { return {thermal, visible, T_visible_thermal}; }
};

TEST(PixelAcross, IsWhereTheOtherCameraSeesTheSamePoint) {
  const Pair pair;
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p_thermal = randomPoint(pair.thermal, 0.8, 0.45, random);
    const auto seen = pair.thermal.projectUnbounded(p_thermal);
    ASSERT_TRUE(seen);
    const auto across = pixelAcross(pair.cameras(), *seen, p_thermal.z());
    ASSERT_TRUE(across);
    EXPECT_THAT(*across, IsNear(*pair.visible.projectUnbounded(pair.T_visible_thermal * p_thermal), 1e-6));
  }
}

TEST(PixelAcross, HasNoAnswerWithoutADepthOrBehindTheOtherCamera) {
  Pair pair;
  for (const double depth : {0.0, -1.0, kNaN, std::numeric_limits<double>::infinity()})
    EXPECT_FALSE(pixelAcross(pair.cameras(), {80.0, 60.0}, depth)) << depth;
  EXPECT_TRUE(pixelAcross(pair.cameras(), {80.0, 60.0}, 2.0));
  pair.T_visible_thermal.translation.z() = -3.0;
  EXPECT_FALSE(pixelAcross(pair.cameras(), {80.0, 60.0}, 2.0));
}

TEST(RegisterPixels, AnswersEveryPixelByItsOwnDepth) {
  const Pair pair;
  std::vector<double> depths(160 * 120);
  for (std::size_t i = 0; i < depths.size(); ++i) depths[i] = 1.0 + 0.01 * static_cast<double>(i % 160);
  depths[5] = kNaN;
  const PixelMap map = registerPixels(pair.cameras(), depths);
  ASSERT_EQ(map.pixels.size(), depths.size());
  EXPECT_TRUE(std::isnan(map.pixels[5].x()));
  EXPECT_THAT(map.pixels[160 * 7 + 50],
              IsNear(*pixelAcross(pair.cameras(), {50.0, 7.0}, depths[160 * 7 + 50]), 1e-12));
}

TEST(RegisterPixels, OneDepthIsASurfaceThatFacesTheCamera) {
  const Pair pair;
  const PixelMap map = registerPixels(pair.cameras(), std::vector<double>{3.0});
  ASSERT_EQ(map.pixels.size(), 160U * 120U);
  EXPECT_THAT(map.pixels.front(), IsNear(*pixelAcross(pair.cameras(), {0.0, 0.0}, 3.0), 1e-12));
  EXPECT_THAT(map.pixels.back(), IsNear(*pixelAcross(pair.cameras(), {159.0, 119.0}, 3.0), 1e-12));
}

// Between the centres the lens is bent: by at most the second derivative / 8, here a hundredth of a pixel.
TEST(PixelMap, InterpolatesBetweenAndBeyondTheCentres) {
  const Pair pair;
  const PixelMap map = registerPixels(pair.cameras(), std::vector<double>{3.0});
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(80.25, 60.75), Eigen::Vector2d(-0.45, 119.45),
                                       Eigen::Vector2d(159.4, -0.4), Eigen::Vector2d(12.0, 5.5)})
    EXPECT_THAT(map.at(pixel), IsNear(*pixelAcross(pair.cameras(), pixel, 3.0), 0.02)) << pixel;
}

TEST(PixelMap, IsNowhereBesideAPixelThatIsNowhere) {
  const Pair pair;
  std::vector<double> depths(160 * 120, 2.0);
  depths[160 * 10 + 10] = kNaN;
  const PixelMap map = registerPixels(pair.cameras(), depths);
  EXPECT_TRUE(std::isnan(map.at({10.4, 9.6}).x()));
  EXPECT_FALSE(std::isnan(map.at({11.4, 9.6}).x()));
}

TEST(NearestDepths, AreThoseOfTheNearestPointToAPixelAtMost) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(-0.5, 63.49), v(-0.5, 47.49), z(1.0, 9.0);
  std::vector<PixelDepth> points;
  for (int i = 0; i < 40; ++i) points.push_back({{std::round(u(random)), std::round(v(random))}, z(random)});
  const std::vector<double> depths = nearestDepths(64, 48, points);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      double nearest = 1e9, taken = 1e9;
      for (const PixelDepth& point : points) {
        const double distance = (point.pixel - Eigen::Vector2d(x, y)).norm();
        nearest = std::min(nearest, distance);
        if (point.depth == depths[static_cast<std::size_t>(64 * y + x)]) taken = distance;
      }
      EXPECT_LT(taken, nearest + 0.5) << x << ", " << y;
    }
  }
}

TEST(NearestDepths, OfTwoPointsInAPixelTheOneInFrontCounts) {
  const std::vector<PixelDepth> points{{{3.2, 2.0}, 5.0}, {{2.9, 2.1}, 2.0}, {{3.0, 1.8}, 7.0}};
  for (const double depth : nearestDepths(8, 6, points)) EXPECT_EQ(depth, 2.0);
}

TEST(NearestDepths, AreNotKnownWithoutAPointInTheImage) {
  const std::vector<PixelDepth> points{
      {{-0.6, 2.0}, 5.0}, {{3.0, 6.0}, 5.0}, {{kNaN, 2.0}, 5.0}, {{2.0, 2.0}, kNaN}, {{2.0, 2.0}, -1.0}};
  for (const double depth : nearestDepths(8, 6, points)) EXPECT_TRUE(std::isnan(depth));
}

}  // namespace
}  // namespace thermovox::test
