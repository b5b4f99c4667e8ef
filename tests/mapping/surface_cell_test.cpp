#include "mapping/surface_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

const Time kNoon(std::chrono::seconds(1'700'000'000));

TemperatureObservation seen(double celsius, double sigma, float range = 5.0F, float incidence = 0.0F) {
  return {static_cast<float>(celsius), static_cast<float>(sigma), range, incidence};
}

SurfaceCell randomCell(std::mt19937& rng) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  SurfaceCell cell;
  const int returns = 1 + static_cast<int>(20 * unit(rng));
  for (int i = 0; i < returns; ++i) cell.addReturn({unit(rng), unit(rng), unit(rng)});
  const int temperatures = static_cast<int>(20 * unit(rng));
  for (int i = 0; i < temperatures; ++i) {
    const auto incidence = unit(rng) < 0.2 ? std::nanf("") : static_cast<float>(1.5 * unit(rng));
    TemperatureObservation observation =
        seen(-50 + 200 * unit(rng), 0.05 + unit(rng), static_cast<float>(20 * unit(rng)), incidence);
    if (unit(rng) < 0.5) observation.common_sigma = static_cast<float>(unit(rng));
    cell.addTemperature(observation, kNoon + std::chrono::milliseconds(static_cast<int>(1e6 * unit(rng))));
  }
  return cell;
}

SurfaceCell merged(SurfaceCell a, const SurfaceCell& b) {
  a.merge(b);
  return a;
}

TEST(SurfaceCell, TakesZeroCelsiusForATemperature) {
  SurfaceCell cell;
  EXPECT_EQ(cell.observations, 0U);
  cell.addTemperature(seen(0.0, 0.1), kNoon);
  EXPECT_EQ(cell.observations, 1U);
  EXPECT_NEAR(cell.mean(), 0.0, 1e-9);
  EXPECT_NEAR(cell.spread(), 0.0, 0.1 / 16);  // by which squares are rounded
  EXPECT_NEAR(cell.sigmaOfMean(), 0.1, 1e-5);
}

TEST(SurfaceCell, KeepsAConstantAfterManyObservations) {
  SurfaceCell cell;
  for (int i = 0; i < 100000; ++i) cell.addTemperature(seen(200.125, 0.05), kNoon);
  EXPECT_NEAR(cell.mean(), 200.125, 1e-6);
  EXPECT_NEAR(cell.spread(), 0.0, 0.05 / 16);
}

TEST(SurfaceCell, AgreesWithWeightedStatisticsInDoubles) {
  std::mt19937 rng(2);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> sigma_of(0.2, 0.6);
  SurfaceCell cell;
  double weights = 0.0, sum = 0.0, squares = 0.0;
  for (int i = 0; i < 4; ++i) {  // so few that none is guarded
    const double sigma = static_cast<float>(sigma_of(rng));
    const double celsius = static_cast<float>(60.0 + sigma * noise(rng));
    cell.addTemperature(seen(celsius, sigma), kNoon);
    const double weight = 1.0 / (sigma * sigma);
    weights += weight;
    sum += weight * celsius;
    squares += weight * celsius * celsius;
  }
  const double mean = sum / weights;
  EXPECT_NEAR(cell.mean(), mean, 1e-3);  // each temperature is rounded by 1 mK, each weight by 2e-4 of it
  const double spread = std::sqrt(squares / weights - mean * mean);
  EXPECT_NEAR(cell.sigmaOfMean(), std::max(std::sqrt(1.0 / weights), spread / 2.0), 1e-3);
  EXPECT_NEAR(cell.spread(), spread, 1e-3);
}

TEST(SurfaceCell, AveragesNoiseAwayWithoutBias) {
  std::mt19937 rng(4);
  std::normal_distribution<double> noise(0.0, 0.5);
  SurfaceCell cell;
  for (int i = 0; i < 10000; ++i) cell.addTemperature(seen(35.0 + noise(rng), 0.5), kNoon);
  EXPECT_NEAR(cell.mean(), 35.0, 0.02);
  EXPECT_NEAR(cell.spread(), 0.5, 0.02);
  EXPECT_NEAR(cell.sigmaOfMean(), 0.005, 0.0005);  // Huber's weights cost a little
}

TEST(SurfaceCell, IsNotMovedByAPasserBy) {
  SurfaceCell cell;
  for (int i = 0; i < 50; ++i) cell.addTemperature(seen(20.0, 0.1), kNoon);
  for (int i = 0; i < 5; ++i) cell.addTemperature(seen(35.0, 0.1), kNoon);
  EXPECT_NEAR(cell.mean(), 20.0, 0.25);  // the plain mean would be 21.4
  EXPECT_DOUBLE_EQ(cell.maxCelsius(), 35.0);
  EXPECT_EQ(cell.observations, 55U);
}

/// 60 observations of a surface of 20 C and 20 of something of 35 C, in the order of `warm`.
template <typename Warm>
SurfaceCell disturbed(double sigma, Warm&& warm) {
  SurfaceCell cell;
  for (int i = 0; i < 80; ++i) cell.addTemperature(seen(warm(i) ? 35.0 : 20.0, sigma), kNoon);
  return cell;
}

TEST(SurfaceCell, SaysHowFarOutliersMayHaveMovedIt) {
  for (const double sigma : {0.05, 0.1, 0.3}) {
    for (const SurfaceCell& cell :
         {disturbed(sigma, [](int i) { return i >= 60; }), disturbed(sigma, [](int i) { return i < 20; }),
          disturbed(sigma, [](int i) { return i % 4 == 3; })}) {
      const double moved = std::abs(cell.mean() - 20.0);
      SCOPED_TRACE(testing::Message() << "sigma " << sigma << " C, moved by " << moved << " C");
      EXPECT_GT(moved, 1.5);
      EXPECT_GE(cell.sigmaOfMean(), moved);
      EXPECT_LE(cell.sigmaOfMean(), 1.2 * moved);  // and claims no wider a bar than that
    }
  }
}

TEST(SurfaceCell, WidensItsSigmaByTheBirgeRatioOfItsObservations) {
  SurfaceCell cell;  // scattered by 0.15 C where 0.1 C is promised
  for (int i = 0; i < 100; ++i) cell.addTemperature(seen(i % 2 == 0 ? 40.15 : 39.85, 0.1), kNoon);
  EXPECT_NEAR(cell.spread(), 0.15, 1e-3);
  EXPECT_NEAR(cell.sigmaOfMean(), 0.15 / 10.0, 1e-4);
}

TEST(SurfaceCell, KeepsTheSigmaOfObservationsThatAgree) {
  std::mt19937 rng(6);
  std::normal_distribution<double> noise(0.0, 0.3);
  for (const int count : {2, 5, 20, 100, 1000}) {
    int wide = 0;
    for (int round = 0; round < 200; ++round) {
      SurfaceCell cell;
      for (int i = 0; i < count; ++i) cell.addTemperature(seen(35.0 + noise(rng), 0.3), kNoon);
      wide += cell.sigmaOfMean() > 2.0 * 0.3 / std::sqrt(count);
    }
    EXPECT_LE(wide, 4) << count << " observations";
  }
}

TEST(SurfaceCell, RecoversWhenThePasserByCameFirst) {
  SurfaceCell cell;
  for (int i = 0; i < 4; ++i) cell.addTemperature(seen(35.0, 0.1), kNoon);
  for (int i = 0; i < 100; ++i) cell.addTemperature(seen(20.0, 0.1), kNoon);
  EXPECT_NEAR(cell.mean(), 20.0, 1.5);
}

TEST(SurfaceCell, HoldsTheExtremesOfItsRangeOverManyMerges) {
  SurfaceCell cell;
  cell.addTemperature(seen(3000.0, 0.01), kNoon);
  for (int i = 0; i < 22; ++i) cell.merge(SurfaceCell(cell));
  EXPECT_EQ(cell.observations, SurfaceCell::kMaxObservations);
  EXPECT_NEAR(cell.mean(), 3000.0, 1e-6);
  EXPECT_NEAR(cell.spread(), 0.0, 0.02 / 16);
  const SurfaceCell full = cell;
  for (int i = 0; i < 3; ++i) cell.merge(full);  // too many for one cell
  EXPECT_EQ(cell, full);
  cell.addReturn({0.5, 0.5, 0.5});
  EXPECT_TRUE(cell.isPlausible());
  SurfaceCell cold;
  cold.addTemperature(seen(-500.0, 1000.0), kNoon);
  EXPECT_NEAR(cold.mean(), -273.15, 1e-3);
  EXPECT_NEAR(cold.sigmaOfMean(), 32.0, 1e-9);
}

TEST(SurfaceCell, KeepsTheBusierOfTwoThatAreTooManyTogether) {
  SurfaceCell warm, cool;
  warm.addTemperature(seen(50.0, 0.1), kNoon);
  cool.addTemperature(seen(10.0, 0.1), kNoon);
  for (int i = 0; i < 21; ++i) warm.merge(SurfaceCell(warm));
  for (int i = 0; i < 21; ++i) cool.merge(SurfaceCell(cool));
  warm.addTemperature(seen(50.0, 0.1), kNoon);
  EXPECT_EQ(merged(warm, cool), merged(cool, warm));
  EXPECT_NEAR(merged(warm, cool).mean(), 50.0, 1e-6);
  EXPECT_EQ(merged(warm, cool).observations, (1U << 21) + 1);
  EXPECT_DOUBLE_EQ(merged(warm, cool).minCelsius(), 10.0);
}

TEST(SurfaceCell, MergesInAnyOrderAndGroupingBitForBit) {
  std::mt19937 rng(9);
  for (int i = 0; i < 300; ++i) {
    const SurfaceCell a = randomCell(rng), b = randomCell(rng), c = randomCell(rng);
    EXPECT_EQ(merged(a, b), merged(b, a));
    EXPECT_EQ(merged(merged(a, b), c), merged(a, merged(b, c)));
  }
}

TEST(SurfaceCell, KeepsFirstAndLastTimeAndTheViewWithMostPixels) {
  SurfaceCell cell;
  cell.addTemperature(seen(20, 0.1, 8.0F, 0.0F), kNoon);
  cell.addTemperature(seen(20, 0.1, 4.0F, 0.5F), kNoon + std::chrono::seconds(5));
  cell.addTemperature(seen(20, 0.1, 3.9F, 1.5F), kNoon - std::chrono::seconds(5));
  EXPECT_LE(cell.first(), kNoon - std::chrono::seconds(5));
  EXPECT_GT(cell.first(), kNoon - std::chrono::milliseconds(7200));
  EXPECT_LE(cell.last(), kNoon + std::chrono::seconds(5));
  EXPECT_GT(cell.last(), kNoon + std::chrono::seconds(5) - std::chrono::microseconds(33));
  EXPECT_NEAR(cell.bestView().range, 4.0, 0.005);
  EXPECT_NEAR(cell.bestView().incidence, 0.5, 0.005);
}

TEST(SurfaceCell, KnowsThatAnIncidenceIsUnknown) {
  SurfaceCell cell;
  cell.addTemperature(seen(20, 0.1, 8.0F, std::nanf("")), kNoon);
  EXPECT_TRUE(std::isnan(cell.bestView().incidence));
}

TEST(SurfaceCell, RefusesWhatIsNotFinite) {
  SurfaceCell cell;
  EXPECT_THROW(cell.addTemperature(seen(std::nan(""), 0.1), kNoon), DataError);
  EXPECT_THROW(cell.addTemperature(seen(20.0, std::nan("")), kNoon), DataError);
  EXPECT_THROW(cell.addTemperature(seen(INFINITY, 0.1), kNoon), DataError);
  EXPECT_EQ(cell, SurfaceCell());
}

TEST(SurfaceCell, AveragesThePlacesOfItsReturns) {
  SurfaceCell cell;
  cell.addReturn({0.25, 0.5, 0.999});
  cell.addReturn({0.75, 0.5, 1.0 + 1e-9});
  EXPECT_NEAR(cell.meanOffset().x(), 0.5, 1.0 / 256);
  EXPECT_NEAR(cell.meanOffset().y(), 0.5, 1.0 / 256);
  EXPECT_LT(cell.meanOffset().z(), 1.0);
}

TEST(SurfaceCell, IsPlausibleHoweverItWasBuilt) {
  std::mt19937 rng(10);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    SurfaceCell cell = randomCell(rng);
    EXPECT_TRUE(cell.isPlausible());
    // The ends of what a cell takes, and angles of surfaces that look away.
    const double celsius = unit(rng) < 0.5 ? -300.0 : 3100.0;
    const double sigma = unit(rng) < 0.5 ? 1e-4 : 1e3;
    cell.addTemperature(seen(celsius, sigma, -1.0F, static_cast<float>(7.0 * unit(rng) - 1.0)), kNoon);
    EXPECT_TRUE(cell.isPlausible()) << celsius << " C";
    cell.merge(randomCell(rng));
    EXPECT_TRUE(cell.isPlausible());
  }
}

}  // namespace
}  // namespace thermovox
