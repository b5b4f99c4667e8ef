// The promises of LocalVariance, whatever its windows are.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "projection/thermal_view.hpp"
#include "tests/projection/scene.hpp"

namespace thermovox {
namespace {

using test::imageOf;

constexpr double kBlur = 0.6;
constexpr double kNetd = 0.05;
constexpr int kWidth = 64, kHeight = 48;
const Eigen::Vector2d kMiddle(31.3, 22.8);

TEST(LocalVariance, IsZeroOnAFlatImage) {
  const LocalVariance variance(imageOf(kWidth, kHeight, [](int, int) { return 21.5; }), kBlur, 0.0);
  for (const double error : {0.0, 0.1, 1.0, 5.0}) {
    EXPECT_NEAR(variance.at(kMiddle, error), 0.0, 1e-6);
    EXPECT_NEAR(variance.at({-0.5, -0.5}, error), 0.0, 1e-6);
    EXPECT_NEAR(variance.at({kWidth - 0.5, kHeight - 0.5}, error), 0.0, 1e-6);
  }
}

TEST(LocalVariance, IsZeroOnAFlatPartHoweverHotTheRestIs) {
  const LocalVariance variance(imageOf(kWidth, kHeight, [](int u, int) { return u < 32 ? 20.0 : 520.0; }),
                               kBlur, 0.0);
  // Floats keep 500 C to 3e-5 C; nothing near the camera's own noise may come of the other half.
  EXPECT_LT(variance.at({8, 24}, 0.5), 0.1 * kNetd * kNetd);
  EXPECT_LT(variance.at({56, 24}, 0.5), 0.1 * kNetd * kNetd);
}

TEST(LocalVariance, DoesNotTakeTheCamerasNoiseForStructure) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, kNetd);
  const LocalVariance variance(imageOf(200, 150, [&](int, int) { return 21.5 + noise(random); }), kBlur,
                               kNetd);
  for (const double error : {0.0, 0.3, 2.0}) {
    double sum = 0.0;
    int count = 0;
    for (int v = 10; v < 140; ++v) {
      for (int u = 10; u < 190; ++u, ++count) sum += variance.at(Eigen::Vector2d(u, v), error);
    }
    // Its expectation is subtracted and negative variances are cut to zero: less than half of it can be left.
    EXPECT_LT(sum / count, 0.5 * kNetd * kNetd) << error;
  }
}

TEST(LocalVariance, OnARampIsTheSquaredGradientTimesTheWindow) {
  for (const Eigen::Vector2d& gradient :
       {Eigen::Vector2d(2.0, 0.0), Eigen::Vector2d(0.0, -1.0), Eigen::Vector2d(1.5, 0.5)}) {
    const LocalVariance variance(
        imageOf(kWidth, kHeight, [&](int u, int v) { return 20.0 + gradient.x() * u + gradient.y() * v; }),
        kBlur, 0.0);
    const double blur_only = variance.at(kMiddle, 0.0);
    // A window cut off at 3 sigma and sampled at whole pixels has 2 to 3 % less variance than its Gaussian.
    EXPECT_NEAR(blur_only / (gradient.squaredNorm() * kBlur * kBlur), 1.0, 0.04) << gradient.transpose();
    for (const double error : {0.05, 0.2, 0.5, 1.0, 2.0, 5.0}) {
      const double expected = gradient.squaredNorm() * (kBlur * kBlur + error);
      EXPECT_NEAR(variance.at(kMiddle, error) / expected, 1.0, 0.04)
          << gradient.transpose() << ", error " << error;
    }
  }
}

TEST(LocalVariance, GrowsTowardsAnEdge) {
  const LocalVariance variance(imageOf(kWidth, kHeight, [](int u, int) { return u < 32 ? 20.0 : 60.0; }),
                               kBlur, kNetd);
  const double error = 0.5;
  EXPECT_NEAR(variance.at({12.0, 20.0}, error), 0.0, 1e-3);
  float last = variance.at({25.0, 20.0}, error);
  for (double u = 26.0; u <= 31.0; u += 1.0) {
    const float here = variance.at({u, 20.0}, error);
    EXPECT_GE(here, last) << u;
    last = here;
  }
  EXPECT_GT(last, 100.0F);                              // beside the edge most of the 20 C of half a step ...
  EXPECT_LE(variance.at({31.5, 20.0}, error), 401.0F);  // ... and never more than that: (40 / 2)^2
}

TEST(LocalVariance, GrowsWithTheErrorAndIsContinuousInIt) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> celsius(20.0, 60.0);
  std::vector<float> blocks(400);
  for (float& block : blocks) block = static_cast<float>(celsius(random));
  const auto image = imageOf(
      kWidth, kHeight, [&](int u, int v) { return blocks[static_cast<std::size_t>(v / 4 * 16 + u / 4)]; });
  const LocalVariance variance(image, kBlur, kNetd);
  std::uniform_real_distribution<double> u(4.0, kWidth - 5.0), v(4.0, kHeight - 5.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d pixel(u(random), v(random));
    float last = variance.at(pixel, 0.0);
    for (double error = 0.01; error < 8.0; error += 0.01) {
      const float here = variance.at(pixel, error);
      ASSERT_TRUE(std::isfinite(here) && here >= 0.0F);
      ASSERT_NEAR(here, last, 20.0) << pixel.transpose() << ", error " << error;  // of some 130 C^2 in all
      last = here;
    }
  }
}

TEST(LocalVariance, IsFiniteAroundUnknownPixels) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto holes = imageOf(kWidth, kHeight, [&](int u, int v) {
    return u > 20 && u < 40 && v > 10 && v < 30 ? static_cast<double>(nan) : 20.0;
  });
  const LocalVariance variance(holes, kBlur, 0.0);
  for (double u = -0.5; u < kWidth - 0.5; u += 0.7) {
    for (const double error : {0.0, 0.5, 4.0}) {
      EXPECT_NEAR(variance.at({u, 20.0}, error), 0.0, 1e-4)
          << u;  // an unknown pixel is no step of temperature
    }
  }
  const LocalVariance unknown(imageOf(8, 8, [&](int, int) { return nan; }), kBlur, kNetd);
  EXPECT_EQ(unknown.at({3.0, 3.0}, 1.0), 0.0F);
}

TEST(LocalVariance, IsTheSameToTheBitAtEveryLevel) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> celsius(-20.0, 500.0), hole(0.0, 1.0);
  for (const double holes : {0.0, 0.1}) {
    const auto image = imageOf(kWidth + 3, kHeight, [&](int, int) {
      return hole(random) < holes ? std::numeric_limits<double>::quiet_NaN() : celsius(random);
    });
    const LocalVariance baseline(image, kBlur, kNetd, CpuLevel::baseline);
    for (const CpuLevel level : {CpuLevel::avx2, CpuLevel::avx512}) {
      if (level > cpuLevel()) continue;
      const LocalVariance wide(image, kBlur, kNetd, level);
      for (int i = 0; i < wide.stride() * (kHeight + 2); ++i)
        ASSERT_EQ(wide.texels()[i].variance, baseline.texels()[i].variance) << nameOf(level) << " " << i;
    }
  }
}

TEST(LocalVariance, OfPerfectOpticsStillKnowsThePixelsWidth) {
  const LocalVariance variance(imageOf(kWidth, kHeight, [](int u, int) { return 2.0 * u; }), 0.0, 0.0);
  EXPECT_GT(variance.at(kMiddle, 0.0), 0.0F);
  // A window of a pixel's width is sampled by three pixels and reads low; from half a pixel of error it is
  // right.
  for (const double error : {0.3, 1.0, 2.0}) {
    EXPECT_NEAR(variance.at(kMiddle, error) / (4.0 * (1.0 / 12.0 + error)), 1.0, 0.05) << error;
  }
}

TEST(LocalVariance, TakesImagesOfOneRowAndOneColumn) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(5, 1), std::pair(1, 5)}) {
    const LocalVariance variance(imageOf(width, height, [](int, int) { return 20.0; }), kBlur, 0.0);
    EXPECT_NEAR(variance.at({0.2, 0.1}, 1.0), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace thermovox
