#include "projection/grazing_emissivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thermovox {
namespace {

float lossAt(double angle_deg) {
  return emissivityLoss(static_cast<float>(std::cos(angle_deg * std::numbers::pi / 180.0)));
}

TEST(EmissivityLoss, IsThatOfFresnelsEquationsWithSnellsAngle) {
  // The textbook's form, with the angle of refraction, against ours without it.
  const auto emissivity = [](double a) {
    const double b = std::asin(std::sin(a) / 1.5);
    const double across = std::sin(a - b) / std::sin(a + b);
    const double along = std::tan(a - b) / std::tan(a + b);
    return 1.0 - 0.5 * (across * across + along * along);
  };
  for (double angle = 51.0; angle < 89.0; angle += 1.0) {
    const double expected =
        1.0 - emissivity(angle * std::numbers::pi / 180.0) / emissivity(kSteepestPlainView);
    EXPECT_NEAR(lossAt(angle), expected, 1e-5) << angle;
  }
}

TEST(EmissivityLoss, IsNothingInPlainViewAndEverythingAlongTheSurface) {
  for (const double angle : {0.0, 20.0, 40.0, 49.9}) EXPECT_EQ(lossAt(angle), 0.0F) << angle;
  EXPECT_EQ(emissivityLoss(1.1F), 0.0F);  // a rounding error beyond
  EXPECT_NEAR(emissivityLoss(0.0F), 1.0F, 1e-6);
}

TEST(EmissivityLoss, IsWhatItsDocumentationSays) {
  for (const auto& [angle, loss] :
       {std::pair(55.0, 0.01), std::pair(60.0, 0.03), std::pair(70.0, 0.12), std::pair(80.0, 0.35)})
    EXPECT_NEAR(lossAt(angle), loss, 0.006) << angle;
}

}  // namespace
}  // namespace thermovox
