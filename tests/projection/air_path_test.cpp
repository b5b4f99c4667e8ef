#include "projection/air_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "projection/error.hpp"
#include "tests/support/radiometry.hpp"

namespace thermovox {
namespace {

using test::sc660;

RadiometricParameters humidAir(AtmosphereModel model, double emissivity) {
  RadiometricParameters parameters = sc660();
  parameters.model = model;
  parameters.emissivity = emissivity;
  parameters.reflected = 5.0;
  parameters.atmosphere_temperature = 31.0;
  parameters.humidity = 0.8;
  parameters.window_temperature = 26.0;
  parameters.window_transmission = 0.9;
  return parameters;
}

TEST(AirPath, TurnsAnImageOfNoDistanceIntoThatOfThePoint) {
  // Against decoding the very counts with the point's distance.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> counts(16500.0, 40000.0), distance(0.0, 150.0), e(0.3, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const AtmosphereModel model = i % 2 == 0 ? AtmosphereModel::single : AtmosphereModel::half;
    RadiometricParameters parameters = humidAir(model, e(random));
    const AirPath air(parameters);
    const double raw = counts(random);
    parameters.distance = 0.0;
    const double at_no_distance = celsiusOfCounts(raw, parameters);
    parameters.distance = distance(random);
    const double expected = celsiusOfCounts(raw, parameters);
    SCOPED_TRACE(testing::Message() << raw << " counts at " << parameters.distance << " m");
    if (std::isnan(at_no_distance) || std::isnan(expected)) continue;
    EXPECT_NEAR(air.at(at_no_distance, parameters.distance).celsius, expected, 1e-8);
  }
}

TEST(AirPath, HasTheSlopeOfItsOwnCurve) {
  for (const AtmosphereModel model : {AtmosphereModel::single, AtmosphereModel::half}) {
    const AirPath air(humidAir(model, 0.9));
    for (const double celsius : {-15.0, 0.0, 20.0, 95.0, 300.0}) {
      for (const double distance : {0.0, 1.0, 12.0, 80.0}) {
        const double step = 1e-3;
        const double expected =
            (air.at(celsius + step, distance).celsius - air.at(celsius - step, distance).celsius) /
            (2.0 * step);
        EXPECT_NEAR(air.at(celsius, distance).slope, expected, 1e-6);  // the difference quotient's own error
      }
    }
  }
}

TEST(AirPath, WithoutDistanceLeavesWhatWasRead) {
  const AirPath air(humidAir(AtmosphereModel::single, 0.9));
  for (const double celsius : {-40.0, 0.0, 37.0, 500.0}) {
    EXPECT_NEAR(air.at(celsius, 0.0).celsius, celsius, 1e-9);
    EXPECT_NEAR(air.at(celsius, 0.0).slope, 1.0, 1e-9);
  }
}

TEST(AirPath, KnowsNoTemperatureWhereNoneGivesTheSignal) {
  const AirPath air(humidAir(AtmosphereModel::single, 0.9));
  EXPECT_TRUE(std::isnan(air.at(std::nan(""), 10.0).celsius));
  EXPECT_TRUE(std::isnan(air.at(-150.0, 50.0).celsius));  // colder than the air it is seen through allows
  EXPECT_TRUE(std::isnan(air.at(20.0, 1e6).celsius));     // the model's air lets nothing through
}

TEST(AirPath, RefusesParametersThatCannotBe) {
  RadiometricParameters parameters = sc660();
  parameters.humidity = 50.0;
  EXPECT_THROW(AirPath{parameters}, ConfigError);
}

}  // namespace
}  // namespace thermovox
