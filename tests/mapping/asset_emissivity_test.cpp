#include "mapping/asset_emissivity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/radiometry.hpp"

namespace thermovox {
namespace {

constexpr AssumedSurface kAssumed{.emissivity = 0.95, .reflected = 20.0};

/// What a camera with its own constants would have measured with the other emissivity from the start.
double asMeasured(double celsius, double emissivity, double b) {
  RadiometricParameters camera = test::sc660();
  camera.planck.b = b;
  camera.distance = 0.0;
  camera.emissivity = kAssumed.emissivity;
  camera.reflected = kAssumed.reflected;
  const double counts = countsOfCelsius(celsius, camera);
  camera.emissivity = emissivity;
  return celsiusOfCounts(counts, camera);
}

TEST(AssetEmissivity, AgreesWithTheCameraThatKnewItFromTheStart) {
  for (const double celsius : {-10.0, 25.0, 40.0, 60.0, 100.0, 150.0}) {
    for (const double emissivity : {0.6, 0.8, 0.9, 1.0}) {
      const double corrected = withEmissivity({celsius, 0.1}, kAssumed, emissivity)->value;
      EXPECT_NEAR(corrected, asMeasured(celsius, emissivity, 1430.0), 1e-9);
      for (const double b : {1360.0, 1510.0}) {  // other cameras: within 4 % of the correction
        const double truth = asMeasured(celsius, emissivity, b);
        EXPECT_NEAR(corrected, truth, 0.04 * std::abs(truth - celsius) + 1e-9)
            << celsius << " " << emissivity;
      }
    }
  }
}

TEST(AssetEmissivity, IsAsLargeAsDocumented) {
  const double corrected = withEmissivity({100.0, 0.1}, kAssumed, 0.6)->value;
  EXPECT_NEAR(corrected - 100.0, 33.4, 0.1);
  EXPECT_NEAR(corrected, asMeasured(100.0, 0.6, 1360.0), 0.9);
  EXPECT_NEAR(corrected, asMeasured(100.0, 0.6, 1510.0), 0.95);
}

TEST(AssetEmissivity, SigmaGrowsAsTheTemperatureDoes) {
  constexpr double kStep = 1e-3;
  const Estimate low = *withEmissivity({80.0 - kStep, 0.2}, kAssumed, 0.4);
  const Estimate high = *withEmissivity({80.0 + kStep, 0.2}, kAssumed, 0.4);
  EXPECT_NEAR(high.sigma, 0.2 * (high.value - low.value) / (2.0 * kStep), 1e-5);
  EXPECT_GT(high.sigma, 0.3);
}

TEST(AssetEmissivity, LeavesWhatIsAlikeAsItIs) {
  EXPECT_EQ(withEmissivity({73.21, 0.2}, kAssumed, 0.95)->value, 73.21);
  EXPECT_NEAR(withEmissivity({20.0, 0.2}, kAssumed, 0.3)->value, 20.0, 1e-9);  // as warm as what it mirrors
}

TEST(AssetEmissivity, KnowsNoTemperatureForTooLittleRadiation) {
  EXPECT_FALSE(withEmissivity({-60.0, 0.2}, {.emissivity = 0.95, .reflected = 40.0}, 0.05));
}

}  // namespace
}  // namespace thermovox
