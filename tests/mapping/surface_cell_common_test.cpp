// Errors that the views of a cell have in common: they do not average out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "mapping/surface_cell.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

const Time kNoon(std::chrono::seconds(1'700'000'000));

TemperatureObservation seen(double celsius, double sigma, double common) {
  return {.celsius = static_cast<float>(celsius),
          .sigma = static_cast<float>(sigma),
          .range = 5.0F,
          .incidence = 1.0F,
          .common_sigma = static_cast<float>(common)};
}

/// By which a common sigma is rounded, C.
double halfStepAt(double common) {
  return 0.5 * std::sqrt(common * 4.0 / 2048.0) + 1.0 / 2048.0;
}

/// `count` views of a surface of 40 C that lack `common` C, with noise.
void addGrazing(SurfaceCell& cell, int count, double common, double sigma = 0.1) {
  std::mt19937 random(count);
  std::normal_distribution<double> noise(0.0, sigma);
  for (int i = 0; i < count; ++i)
    cell.addTemperature(seen(40.0 - common + noise(random), sigma, common), kNoon);
}

TEST(CommonSigma, OfOneObservationEntersOnce) {
  for (const double common : {0.0, 0.01, 0.1, 0.5, 1.5}) {
    SurfaceCell cell;
    cell.addTemperature(seen(40.0, 0.1, common), kNoon);
    // Roots of common sigmas are whole steps; so are weights, which are small for large ones.
    EXPECT_NEAR(cell.commonSigma(), common, halfStepAt(common)) << common;
    EXPECT_NEAR(cell.sigmaOfMean(), std::hypot(0.1, cell.commonSigma()), 0.1 * common + 1e-4) << common;
  }
}

TEST(CommonSigma, IsWhatManyEqualObservationsComeDownTo) {
  for (const double common : {0.05, 0.3, 3.0}) {
    for (const int count : {10, 100, 10000}) {
      SurfaceCell cell;
      addGrazing(cell, count, common);
      const double floor = cell.commonSigma();
      SCOPED_TRACE(testing::Message() << count << " with " << common << " C");
      EXPECT_NEAR(floor, common, halfStepAt(common));
      EXPECT_GE(cell.sigmaOfMean(), floor);
      EXPECT_LE(cell.sigmaOfMean(), std::hypot(floor, 0.15 / std::sqrt(count)) + 0.03 * floor);
      EXPECT_GE(2.0 * cell.sigmaOfMean(), std::abs(cell.mean() - 40.0));
    }
  }
}

TEST(CommonSigma, OneSteepViewStandsAgainstManyGrazingOnes) {
  for (const bool steep_first : {true, false}) {
    SurfaceCell cell;
    if (steep_first) cell.addTemperature(seen(40.0, 0.1, 0.0), kNoon);
    addGrazing(cell, 20, 3.0);
    if (!steep_first) cell.addTemperature(seen(40.0, 0.1, 0.0), kNoon);
    EXPECT_EQ(cell.commonSigma(), 0.0);
    EXPECT_NEAR(cell.mean(), 40.0, 0.05) << steep_first;
    EXPECT_LT(cell.sigmaOfMean(), 0.6);
    EXPECT_GE(cell.sigmaOfMean(), std::abs(cell.mean() - 40.0));
  }
}

// Ten steep views of 0.1 C among 100 that lack something: what little these weigh stays within the bar, or
// within half a NETD, where the noise of 110 views is averaged to less than what a tenth of a NETD lacks.
TEST(CommonSigma, MixedViewsMoveTheMeanLittleMoreThanItsSigma) {
  for (const double common : {0.05, 0.1, 0.3, 1.0, 3.0}) {
    SurfaceCell cell;
    addGrazing(cell, 100, common);
    for (int i = 0; i < 10; ++i) cell.addTemperature(seen(40.0, 0.1, 0.0), kNoon);
    EXPECT_LE(std::abs(cell.mean() - 40.0), std::max(2.0 * cell.sigmaOfMean(), 0.05)) << common;
  }
}

// Otherwise Huber's guard would take the first view from ahead for a glint.
TEST(CommonSigma, IsNoReasonToGuardTheFirstViewFromAhead) {
  SurfaceCell cell;
  addGrazing(cell, 100, 3.0);
  const std::uint64_t before = cell.weight_sum;
  cell.addTemperature(seen(40.0, 0.1, 0.0), kNoon);
  EXPECT_NEAR(static_cast<double>(cell.weight_sum - before), 1024.0 / (0.1 * 0.1), 1.0);
}

TEST(CommonSigma, OfMergedMapsIsTheLeastOfThem) {
  SurfaceCell steep, grazing, more;
  addGrazing(steep, 5, 0.2);
  addGrazing(grazing, 50, 2.0);
  addGrazing(more, 50, 2.0);
  grazing.merge(more);
  EXPECT_NEAR(grazing.commonSigma(), 2.0, 0.04);
  EXPECT_NEAR(grazing.sigmaOfMean(), 2.0, 0.05);
  SurfaceCell empty;
  empty.merge(grazing);
  EXPECT_EQ(empty, grazing);
  grazing.merge(SurfaceCell{});
  EXPECT_EQ(empty, grazing);
  grazing.merge(steep);
  EXPECT_EQ(grazing.commonSigma(), steep.commonSigma());
}

TEST(CommonSigma, GoesWithTheSumsOfTheBusierOfTwoThatAreTooManyTogether) {
  SurfaceCell grazing, steep;
  addGrazing(grazing, 2, 2.0);
  addGrazing(steep, 1, 0.0);
  for (int i = 0; i < 21; ++i) grazing.merge(SurfaceCell(grazing));
  for (int i = 0; i < 21; ++i) steep.merge(SurfaceCell(steep));
  SurfaceCell both = grazing, other = steep;
  both.merge(steep);
  other.merge(grazing);
  EXPECT_NEAR(both.commonSigma(), 2.0, 0.04);
  EXPECT_EQ(both.common_code, other.common_code);
  EXPECT_TRUE(both.isPlausible());
}

TEST(CommonSigma, OfViewsOfUnknownAngleIsThatOfTheKnownOnes) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  SurfaceCell cell;
  for (int i = 0; i < 100; ++i) cell.addTemperature(seen(40.0, 0.05, 4.0), kNoon);
  SurfaceCell sparse;
  sparse.addTemperature({.celsius = 44.0F, .sigma = 0.05F, .range = 3.0F, .incidence = unknown}, kNoon);
  EXPECT_EQ(sparse.commonSigma(), 0.0);
  SurfaceCell both = cell;
  both.merge(sparse);
  EXPECT_NEAR(both.commonSigma(), 4.0, 0.1);
  EXPECT_GT(both.sigmaOfMean(), 3.9);
  sparse.merge(cell);
  EXPECT_EQ(sparse, both);
  EXPECT_TRUE(both.isPlausible());
}

TEST(CommonSigma, IsTakenWithinWhatAByteHolds) {
  SurfaceCell cell;
  cell.addTemperature(seen(40.0, 0.1, 1000.0), kNoon);
  EXPECT_NEAR(cell.commonSigma(), 31.50, 0.01);
  EXPECT_TRUE(cell.isPlausible());
  EXPECT_THROW(cell.addTemperature(seen(40.0, 0.1, std::nan("")), kNoon), DataError);
}

}  // namespace
}  // namespace thermovox
