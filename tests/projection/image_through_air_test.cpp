#include "projection/image_through_air.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace thermovox {
namespace {

/// A FLIR E40 in warm, humid air.
RadiometricParameters humid() {
  RadiometricParameters parameters;
  parameters.planck = {.r1 = 14259.625, .r2 = 0.010985606, .b = 1383.2, .f = 1.0, .o = -5667.0};
  parameters.atmosphere_temperature = 35.0;
  parameters.humidity = 0.9;
  return parameters;
}

TEST(ImageThroughAir, GivesEveryPixelTheAirOfItsOwnDistance) {
  const ThermalImage image{.width = 2,
                           .height = 2,
                           .celsius = {25.0F, 25.0F, std::numeric_limits<float>::quiet_NaN(), 80.0F},
                           .air = std::make_shared<const AirPath>(humid()),
                           .calibrated_range = CalibratedRange{-20.0, 120.0}};
  const ThermalImage seen =
      imageThroughAir(image, std::vector<double>{3.0, 30.0, 3.0, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(seen.celsius[0], static_cast<float>(image.air->at(25.0, 3.0).celsius));
  EXPECT_EQ(seen.celsius[1], static_cast<float>(image.air->at(25.0, 30.0).celsius));
  EXPECT_LT(seen.celsius[1], seen.celsius[0] - 0.5F) << "more of the warm air is in it";
  EXPECT_TRUE(std::isnan(seen.celsius[2]));
  EXPECT_TRUE(std::isnan(seen.celsius[3])) << "no distance is known";
  EXPECT_EQ(seen.air, nullptr);
  EXPECT_EQ(seen.calibrated_range->high, 120.0);
}

TEST(ImageThroughAir, LeavesTemperaturesOfTheCamerasOwnMaking) {
  const ThermalImage image{.width = 2, .height = 1, .celsius = {25.0F, 80.0F}};
  EXPECT_EQ(imageThroughAir(image, std::vector<double>{3.0, 30.0}).celsius, image.celsius);
}

}  // namespace
}  // namespace thermovox
