#include "projection/radiometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "projection/error.hpp"
#include "projection/radiometric_overrides.hpp"
#include "tests/support/radiometry.hpp"

namespace thermovox {
namespace {

using test::sc660;

RadiometricParameters anyParameters(std::mt19937_64& random) {
  const auto from = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  RadiometricParameters parameters = sc660();
  parameters.emissivity = from(0.3, 1.0);
  parameters.distance = from(0.0, 100.0);
  parameters.reflected = from(-60.0, 80.0);
  parameters.atmosphere_temperature = from(-20.0, 40.0);
  parameters.humidity = from(0.0, 1.0);
  parameters.window_temperature = from(-20.0, 60.0);
  parameters.window_transmission = from(0.5, 1.0);
  parameters.model = random() % 2 == 0 ? AtmosphereModel::single : AtmosphereModel::half;
  return parameters;
}

TEST(Radiometry, GivesThePublishedNumbersOfBothModels) {
  // The README of Thermimage: raw2temp(17994.06, E = 0.95, IRT = 0.96, ...) is 23.31223.
  RadiometricParameters parameters = sc660();
  parameters.window_transmission = 0.96;
  parameters.model = AtmosphereModel::half;
  EXPECT_NEAR(celsiusOfCounts(17994.06, parameters), 23.31223, 1e-5);
  parameters.model = AtmosphereModel::single;
  EXPECT_NEAR(celsiusOfCounts(17994.06, parameters), 23.304108, 1e-5);
}

TEST(Radiometry, HasTheModelsApartByHowFarTheAirReaches) {
  // 25000 counts at 1, 20, 50 and 100 metres of air at 20 C and 50 %.
  for (const auto& [distance, apart] :
       {std::pair{1.0, 0.08}, std::pair{20.0, 0.36}, std::pair{50.0, 0.58}, std::pair{100.0, 0.83}}) {
    RadiometricParameters parameters = sc660();
    parameters.distance = distance;
    const double single = celsiusOfCounts(25000.0, parameters);
    parameters.model = AtmosphereModel::half;
    EXPECT_NEAR(celsiusOfCounts(25000.0, parameters) - single, apart, 0.005) << distance;
  }
}

TEST(Radiometry, ObjectWindowAirAndMirrorAddUpToTheCounts) {
  // The radiation forwards, as the manuals of the cameras write it, against the inverse.
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    RadiometricParameters p = anyParameters(random);
    const auto signal = [&](double celsius) {
      return p.planck.r1 / (p.planck.r2 * (std::exp(p.planck.b / (celsius + 273.15)) - p.planck.f)) -
             p.planck.o;
    };
    const double object = std::uniform_real_distribution<double>(-20.0, 150.0)(random);
    const double left = p.emissivity * signal(object) + (1.0 - p.emissivity) * signal(p.reflected);
    const double air = signal(p.atmosphere_temperature);
    const auto through_air = [&](double radiation, double distance) {
      const double tau = transmission(p, distance);
      return tau * radiation + (1.0 - tau) * air;
    };
    const auto through_window = [&](double radiation) {
      return p.window_transmission * radiation + (1.0 - p.window_transmission) * signal(p.window_temperature);
    };
    const double counts =
        p.model == AtmosphereModel::half
            ? through_air(through_window(through_air(left, p.distance / 2.0)), p.distance / 2.0)
            : through_window(through_air(left, p.distance));
    SCOPED_TRACE(testing::Message() << "set " << i << ", " << counts << " counts");
    EXPECT_NEAR(celsiusOfCounts(counts, p), object, 1e-8);
    EXPECT_NEAR(countsOfCelsius(object, p), counts, 1e-8 * counts);
  }
}

TEST(Radiometry, WithoutDistanceThereIsNoAir) {
  for (const AtmosphereModel model : {AtmosphereModel::single, AtmosphereModel::half}) {
    RadiometricParameters parameters = sc660();
    parameters.model = model;
    parameters.distance = 0.0;
    EXPECT_DOUBLE_EQ(transmission(parameters, 0.0), 1.0);
    const double expected = celsiusOfCounts(20000.0, parameters);
    parameters.atmosphere_temperature = -20.0;
    parameters.humidity = 1.0;
    EXPECT_NEAR(celsiusOfCounts(20000.0, parameters), expected, 1e-9);
  }
}

TEST(Radiometry, ABlackBodyBeforeTheLensIsPlanckAlone) {
  RadiometricParameters parameters = sc660();
  parameters.emissivity = 1.0;
  parameters.distance = 0.0;
  EXPECT_NEAR(celsiusOfCounts(18000.0, parameters), parameters.planck.celsius(18000.0), 1e-9);
  EXPECT_NEAR(parameters.planck.celsius(parameters.planck.signal(-40.0)), -40.0, 1e-9);
}

TEST(Radiometry, WhatNoTemperatureGivesIsNotKnown) {
  EXPECT_TRUE(std::isnan(celsiusOfCounts(0.0, sc660())));  // below the camera's offset
  EXPECT_TRUE(std::isnan(celsiusOfCounts(std::nan(""), sc660())));
  RadiometricParameters far = sc660();
  far.distance = 1e5;
  far.atmosphere_temperature = 40.0;
  far.humidity = 1.0;
  EXPECT_LT(transmission(far, far.distance), 0.0);
  EXPECT_TRUE(std::isnan(celsiusOfCounts(18000.0, far)));
}

TEST(Radiometry, RefusesWhatCannotBe) {
  const auto complaint = [](const std::function<void(RadiometricParameters&)>& change) -> std::string {
    RadiometricParameters parameters = sc660();
    change(parameters);
    try {
      parameters.validate();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return {};
  };
  using Parameters = RadiometricParameters;
  EXPECT_EQ(complaint([](Parameters&) {}), "");
  EXPECT_EQ(complaint([](Parameters& p) { p.emissivity = 95.0; }),
            "Radiometry: emissivity is 95, expected 0.05 to 1");
  EXPECT_EQ(complaint([](Parameters& p) { p.humidity = 50.0; }),
            "Radiometry: humidity is 50, expected a fraction from 0 to 1");
  EXPECT_EQ(complaint([](Parameters& p) { p.reflected = std::nan(""); }),
            "Radiometry: reflected temperature is nan, expected a temperature in Celsius above -273.15 and "
            "below 10000");
  EXPECT_NE(complaint([](Parameters& p) { p.distance = -1.0; }), "");
  EXPECT_NE(complaint([](Parameters& p) { p.window_transmission = 0.0; }), "");
  EXPECT_NE(complaint([](Parameters& p) { p.atmosphere.x = HUGE_VAL; }), "");
  EXPECT_NE(complaint([](Parameters& p) { p.planck = {}; }), "");
}

TEST(RadiometricOverrides, StandInForTheFilesOwnValues) {
  const RadiometricOverrides none;
  EXPECT_FALSE(none.any());
  EXPECT_EQ(none.applyTo(sc660()), sc660());
  const RadiometricOverrides own{.emissivity = 0.8, .model = AtmosphereModel::half};
  const RadiometricOverrides both = own.orElse({.emissivity = 0.5, .humidity = 0.3});
  EXPECT_TRUE(both.any());
  RadiometricParameters expected = sc660();
  expected.emissivity = 0.8;
  expected.humidity = 0.3;
  expected.model = AtmosphereModel::half;
  EXPECT_EQ(both.applyTo(sc660()), expected);
}

}  // namespace
}  // namespace thermovox
