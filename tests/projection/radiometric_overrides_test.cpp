#include "projection/radiometric_overrides.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const RadiometricOverrides kAll{.emissivity = 0.8,
                                .distance = 12.0,
                                .reflected = -40.0,
                                .atmosphere_temperature = 35.0,
                                .humidity = 0.9,
                                .window_temperature = 30.0,
                                .window_transmission = 0.85,
                                .model = AtmosphereModel::half};

RadiometricParameters someCamera() {
  RadiometricParameters parameters;
  parameters.planck = {14259.625, 0.010985606, 1383.2, 1.0, -5667.0};
  parameters.atmosphere.x = 1.8;
  return parameters;
}

/// The same without one of its values.
std::vector<RadiometricOverrides> oneMissing(const RadiometricOverrides& all) {
  std::vector<RadiometricOverrides> cases(8, all);
  cases[0].emissivity.reset();
  cases[1].distance.reset();
  cases[2].reflected.reset();
  cases[3].atmosphere_temperature.reset();
  cases[4].humidity.reset();
  cases[5].window_temperature.reset();
  cases[6].window_transmission.reset();
  cases[7].model.reset();
  return cases;
}

TEST(RadiometricOverrides, TakeThePlaceOfWhatIsThereAndOfNothingElse) {
  const RadiometricParameters camera = someCamera();
  const RadiometricParameters changed = kAll.applyTo(camera);
  EXPECT_EQ(changed.planck, camera.planck);
  EXPECT_EQ(changed.atmosphere, camera.atmosphere);
  EXPECT_EQ(changed.emissivity, 0.8);
  EXPECT_EQ(changed.distance, 12.0);
  EXPECT_EQ(changed.reflected, -40.0);
  EXPECT_EQ(changed.atmosphere_temperature, 35.0);
  EXPECT_EQ(changed.humidity, 0.9);
  EXPECT_EQ(changed.window_temperature, 30.0);
  EXPECT_EQ(changed.window_transmission, 0.85);
  EXPECT_EQ(changed.model, AtmosphereModel::half);
}

TEST(RadiometricOverrides, LeaveTheCamerasValueWhereTheyHaveNone) {
  const RadiometricParameters camera = someCamera();
  EXPECT_EQ(RadiometricOverrides().applyTo(camera), camera);
  EXPECT_EQ(kAll.applyTo(kAll.applyTo(camera)), kAll.applyTo(camera));
  for (const RadiometricOverrides& most : oneMissing(kAll)) {
    EXPECT_NE(most.applyTo(camera), kAll.applyTo(camera));
    EXPECT_EQ(kAll.applyTo(most.applyTo(camera)), kAll.applyTo(camera));
  }
}

TEST(RadiometricOverrides, AreAnyWithOneValue) {
  EXPECT_FALSE(RadiometricOverrides().any());
  EXPECT_TRUE(RadiometricOverrides{.humidity = 0.0}.any()) << "0 is a value";
  EXPECT_TRUE(RadiometricOverrides{.model = AtmosphereModel::single}.any()) << "the usual one is one";
}

TEST(RadiometricOverrides, ComeBeforeOthersValueByValue) {
  EXPECT_EQ(RadiometricOverrides().orElse(kAll), kAll);
  EXPECT_EQ(kAll.orElse({.emissivity = 0.5, .model = AtmosphereModel::single}), kAll);
  for (const RadiometricOverrides& most : oneMissing(kAll)) EXPECT_EQ(most.orElse(kAll), kAll);
  const RadiometricOverrides both = RadiometricOverrides{.humidity = 0.0}.orElse({.reflected = 5.0});
  EXPECT_EQ(both, (RadiometricOverrides{.reflected = 5.0, .humidity = 0.0}));
}

TEST(RadiometricOverrides, MayLieAtTheirLimits) {
  EXPECT_NO_THROW(RadiometricOverrides().validate());
  EXPECT_NO_THROW(kAll.validate());
  for (const double emissivity : {0.05, 1.0})
    EXPECT_NO_THROW((RadiometricOverrides{.emissivity = emissivity}.validate()));
  for (const double humidity : {0.0, 1.0})
    EXPECT_NO_THROW((RadiometricOverrides{.humidity = humidity}.validate()));
  EXPECT_NO_THROW((RadiometricOverrides{.distance = 0.0}.validate()));
}

TEST(RadiometricOverrides, AreRefusedBeyondThemByName) {
  const auto complaint = [](const RadiometricOverrides& overrides) {
    return test::messageOf<ConfigError>([&] { overrides.validate(); });
  };
  for (const double value : {0.049, 1.001, 0.0, -1.0, kNaN, kInfinity}) {
    EXPECT_THAT(complaint({.emissivity = value}), HasSubstr("emissivity"));
    EXPECT_THAT(complaint({.window_transmission = value}), HasSubstr("window transmission"));
  }
  for (const double value : {-0.001, 1.001, kNaN})
    EXPECT_THAT(complaint({.humidity = value}), HasSubstr("humidity"));
  for (const double value : {-0.001, kNaN, kInfinity})
    EXPECT_THAT(complaint({.distance = value}), HasSubstr("distance"));
  for (const double value : {-273.15, -300.0, kNaN, kInfinity}) {
    EXPECT_THAT(complaint({.reflected = value}), HasSubstr("reflected temperature"));
    EXPECT_THAT(complaint({.atmosphere_temperature = value}), HasSubstr("atmosphere temperature"));
    EXPECT_THAT(complaint({.window_temperature = value}), HasSubstr("window temperature"));
  }
}

}  // namespace
}  // namespace thermovox
