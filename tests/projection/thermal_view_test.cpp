#include "projection/thermal_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "tests/projection/scene.hpp"

namespace thermovox {
namespace {

using test::imageOf;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kNetd = 0.05;

ThermalImage noise(int width, int height, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> celsius(-20.0, 120.0);
  return imageOf(width, height, [&](int, int) { return celsius(random); });
}

TEST(SampleTemperature, IsBilinearInCelsius) {
  const ThermalImage image = noise(24, 18, 1);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> u(0.0, 23.0), v(0.0, 17.0);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d pixel(u(random), v(random));
    const int u0 = std::min(static_cast<int>(pixel.x()), 22), v0 = std::min(static_cast<int>(pixel.y()), 16);
    const double a = pixel.x() - u0, b = pixel.y() - v0;
    const double expected = (1 - a) * (1 - b) * image.at(u0, v0) + a * (1 - b) * image.at(u0 + 1, v0) +
                            (1 - a) * b * image.at(u0, v0 + 1) + a * b * image.at(u0 + 1, v0 + 1);
    const auto sample = sampleTemperature(image, pixel, kNetd);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->celsius, expected, 1e-4) << pixel.transpose();  // 120 C in floats: 1e-5, four times
    const double squares = ((1 - a) * (1 - a) + a * a) * ((1 - b) * (1 - b) + b * b);
    EXPECT_NEAR(sample->noise_sigma, kNetd * std::sqrt(squares), 1e-6);
  }
}

TEST(SampleTemperature, AtACentreIsThePixel) {
  const ThermalImage image = noise(24, 18, 1);
  for (int v = 0; v < 18; ++v) {
    for (int u = 0; u < 24; ++u) {
      const auto sample = sampleTemperature(image, Eigen::Vector2d(u, v), kNetd);
      ASSERT_TRUE(sample);
      EXPECT_EQ(sample->celsius, image.at(u, v));
      EXPECT_EQ(sample->noise_sigma, static_cast<float>(kNetd));
    }
  }
}

TEST(SampleTemperature, AveragesTheNoiseAsItSays) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> error(0.0, kNetd);
  const Eigen::Vector2d pixel(10.3, 7.8);
  double sum = 0.0;
  float claimed = 0.0F;
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    ThermalImage image{.width = 12, .height = 10, .celsius = std::vector<float>(120, 21.0F)};
    for (const int at : {7 * 12 + 10, 7 * 12 + 11, 8 * 12 + 10, 8 * 12 + 11}) {
      image.celsius[static_cast<std::size_t>(at)] += static_cast<float>(error(random));
    }
    const TemperatureSample sample = sampleTemperature(image, pixel, kNetd).value();
    sum += std::pow(sample.celsius - 21.0, 2);
    claimed = sample.noise_sigma;
  }
  // The standard deviation of 20 000 draws is good to 1 / sqrt(2 * 20 000) = 0.5 %; four of these.
  EXPECT_NEAR(std::sqrt(sum / kDraws) / claimed, 1.0, 0.02);
}

TEST(SampleTemperature, LeavesUnknownPixelsOutOfTheMean) {
  ThermalImage image = imageOf(4, 4, [](int u, int v) { return 10.0 * u + 100.0 * v; });
  image.celsius[1 * 4 + 2] = kNan;
  // At (1.25, 1.5) the weights of (1,1), (1,2), (2,2) are 0.375, 0.375 and 0.125; (2,1) is not known.
  const auto sample = sampleTemperature(image, {1.25, 1.5}, kNetd);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->celsius, (0.375 * 110 + 0.375 * 210 + 0.125 * 220) / 0.875, 1e-4);
  EXPECT_NEAR(sample->noise_sigma, kNetd * std::sqrt(2 * 0.375 * 0.375 + 0.125 * 0.125) / 0.875, 1e-6);
}

TEST(SampleTemperature, IsUnknownWhereLessThanHalfOfTheWeightIsKnown) {
  ThermalImage image = imageOf(4, 4, [](int, int) { return 20.0; });
  image.celsius[1 * 4 + 2] = kNan;
  EXPECT_TRUE(sampleTemperature(image, {1.49, 1.0}, kNetd));
  EXPECT_FALSE(sampleTemperature(image, {1.51, 1.0}, kNetd));
  EXPECT_FALSE(sampleTemperature(image, {2.0, 1.0}, kNetd));
  image.celsius[1 * 4 + 2] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(sampleTemperature(image, {2.0, 1.0}, kNetd));
}

TEST(SampleTemperature, RepeatsTheBorderToTheImagesEdge) {
  const ThermalImage image = imageOf(5, 4, [](int u, int v) { return 10.0 * u + 100.0 * v; });
  EXPECT_FLOAT_EQ(sampleTemperature(image, {-0.4, 2.0}, kNetd)->celsius, 200.0F);
  EXPECT_FLOAT_EQ(sampleTemperature(image, {4.4, 2.0}, kNetd)->celsius, 240.0F);
  EXPECT_FLOAT_EQ(sampleTemperature(image, {3.0, -0.4}, kNetd)->celsius, 30.0F);
  EXPECT_FLOAT_EQ(sampleTemperature(image, {3.0, 3.4}, kNetd)->celsius, 330.0F);
  EXPECT_FALSE(sampleTemperature(image, {-0.6, 2.0}, kNetd));
  EXPECT_FALSE(sampleTemperature(image, {30.0, 2.0}, kNetd));
}

TEST(SampleTemperature, TakesZeroCelsiusForATemperature) {
  const ThermalImage image = imageOf(3, 3, [](int, int) { return 0.0; });
  const auto sample = sampleTemperature(image, {1.5, 1.5}, kNetd);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->celsius, 0.0F);
}

TEST(ThermalView, KnowsBothDirectionsOfTheCamerasPose) {
  const ThermalCamera camera{.camera = Camera(test::intrinsicsOf(LensModel::pinhole, {}, 8, 6))};
  const Pose T_world_camera{expRotation({0.3, -0.2, 1.0}), {1, 2, 3}};
  const ThermalView view(test::frameOf(imageOf(8, 6, [](int, int) { return 20.0; })), T_world_camera, camera);
  const Eigen::Vector3d p(4, 5, 6);
  EXPECT_LT((view.T_camera_world * (view.T_world_camera * p) - p).norm(), 1e-12);
  EXPECT_LT((view.T_world_camera.translation - T_world_camera.translation).norm(), 1e-15);
}

}  // namespace
}  // namespace thermovox
