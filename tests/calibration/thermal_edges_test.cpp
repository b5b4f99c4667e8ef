#include "calibration/thermal_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace thermovox {
namespace {

/// A step from 20 C to 25 C across `normal` through a place, blurred by 0.7 px.
ThermalImage step(const Eigen::Vector2d& place, const Eigen::Vector2d& normal, double noise) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normally(0.0, noise);
  ThermalImage image{.width = 40, .height = 30, .celsius = {}};
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double across = normal.dot(Eigen::Vector2d(u, v) - place);
      const double celsius = 20.0 + 2.5 * (1.0 + std::erf(across / (0.7 * std::sqrt(2.0))));
      image.celsius.push_back(static_cast<float>(celsius + (noise > 0.0 ? normally(random) : 0.0)));
    }
  }
  return image;
}

TEST(ThermalEdges, LieWhereTheTemperatureSteps) {
  for (const double turn : {0.0, 0.3, 0.8, 1.6, 3.0, 4.4}) {
    SCOPED_TRACE(turn);
    const Eigen::Vector2d normal(std::cos(turn), std::sin(turn)), place(19.37, 14.81);
    const ThermalEdges edges(step(place, normal, 0.05), {});
    ASSERT_FALSE(edges.all().empty());
    const auto found = edges.nearest(place + 2.0 * normal, normal, 4.0);
    ASSERT_TRUE(found);
    // The summit of a slope is interpolated linearly between pixels: a tenth of a pixel.
    EXPECT_NEAR(normal.dot(found->pixel - place), 0.0, 0.1);
    EXPECT_GT(found->normal.dot(normal), 0.99) << "towards the warmer side";
    EXPECT_GT(found->sigma_px, 0.0);
    EXPECT_LT(found->sigma_px, 0.1);
  }
}

TEST(ThermalEdges, AreLookedForAcrossAndWithinReach) {
  const Eigen::Vector2d place(20.0, 15.0);
  const ThermalEdges edges(step(place, Eigen::Vector2d::UnitX(), 0.0), {});
  EXPECT_TRUE(edges.nearest({22.0, 15.0}, Eigen::Vector2d::UnitX(), 3.0));
  EXPECT_TRUE(edges.nearest({22.0, 15.0}, -Eigen::Vector2d::UnitX(), 3.0));
  EXPECT_FALSE(edges.nearest({24.0, 15.0}, Eigen::Vector2d::UnitX(), 3.0)) << "too far";
  EXPECT_FALSE(edges.nearest({22.0, 15.0}, Eigen::Vector2d::UnitY(), 3.0)) << "along it";
  EXPECT_FALSE(edges.nearest({-50.0, 400.0}, Eigen::Vector2d::UnitX(), 3.0)) << "outside";
}

TEST(ThermalEdges, NoiseAndUnknownPixelsMakeNone) {
  ThermalImage image = step({-100.0, 0.0}, Eigen::Vector2d::UnitX(), 0.3);
  EXPECT_LT(ThermalEdges(image, {}).all().size(), 3U) << "of noise alone";
  for (float& celsius : image.celsius) celsius = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(ThermalEdges(image, {}).all().empty());
}

TEST(ImageNoise, IsThatOfThePixels) {
  // 1064 pixels tell a sigma to about 4 %, neighbours' masks overlap.
  EXPECT_NEAR(imageNoise(step({20.0, 15.0}, Eigen::Vector2d::UnitX(), 0.2)), 0.2, 0.04);
  EXPECT_EQ(imageNoise(ThermalImage{.width = 2, .height = 1, .celsius = {1.0F, 2.0F}}), 0.0);
}

}  // namespace
}  // namespace thermovox
