#include "io/celsius_decoder.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "projection/error.hpp"
#include "tests/io/flir_file.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

RawThermalImage imageOf(std::vector<std::uint16_t> counts, CelsiusRule rule) {
  return {.width = static_cast<int>(counts.size()), .height = 1, .counts = std::move(counts), .rule = rule};
}

/// What the counts of an E40 are, pixel by pixel, by the formula.
void expectFormula(const ThermalImage& image, const std::vector<std::uint16_t>& counts,
                   const RadiometricParameters& parameters) {
  ASSERT_EQ(image.celsius.size(), counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = celsiusOfCounts(counts[i], parameters);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(image.celsius[i])) << counts[i];
    } else {
      EXPECT_NEAR(image.celsius[i], expected, 1e-4) << counts[i];  // a float at 1000 C
    }
  }
}

const std::vector<std::uint16_t> kCounts{0, 1, 5667, 12000, 17500, 17501, 30000, 65535};

TEST(CelsiusDecoder, FollowsTheFormulaForAnyCount) {
  const ThermalImage image = CelsiusDecoder().decode(imageOf(kCounts, test::e40()), "image");
  EXPECT_EQ(image.width, 8);
  EXPECT_EQ(image.height, 1);
  expectFormula(image, kCounts, test::e40());
}

TEST(CelsiusDecoder, FollowsTheParametersOfEachImage) {
  CelsiusDecoder decoder;
  for (const double emissivity : {0.95, 0.7, 0.7, 0.95}) {
    RadiometricParameters parameters = test::e40();
    parameters.emissivity = emissivity;
    expectFormula(decoder.decode(imageOf(kCounts, parameters), "image"), kCounts, parameters);
  }
}

TEST(CelsiusDecoder, PutsWhatIsKnownBetterInPlaceForThatImageOnly) {
  CelsiusDecoder decoder;
  RadiometricParameters wanted = test::e40();
  wanted.emissivity = 0.6;
  wanted.distance = 30.0;
  expectFormula(decoder.decode(imageOf(kCounts, test::e40()), "image", {.emissivity = 0.6, .distance = 30.0}),
                kCounts, wanted);
  expectFormula(decoder.decode(imageOf(kCounts, test::e40()), "image"), kCounts, test::e40());
}

TEST(CelsiusDecoder, FollowsALinearScaleDownToAbsoluteZero) {
  const ThermalImage image = CelsiusDecoder().decode(imageOf({0, 1, 27315, 31730}, TLinear{}), "image");
  EXPECT_TRUE(std::isnan(image.celsius[0])) << "an empty pixel";
  EXPECT_NEAR(image.celsius[1], -273.14, 1e-4);
  EXPECT_NEAR(image.celsius[2], 0.0, 1e-4);
  EXPECT_NEAR(image.celsius[3], 44.15, 1e-4);
}

TEST(CelsiusDecoder, LeavesTemperaturesAsTheyAre) {
  const RawThermalImage image{.width = 3, .height = 1, .celsius = {-1.5F, kNaN, 20.25F}};
  const ThermalImage decoded = CelsiusDecoder().decode(image, "image");
  EXPECT_EQ(decoded.celsius[0], -1.5F);
  EXPECT_TRUE(std::isnan(decoded.celsius[1]));
  EXPECT_EQ(decoded.celsius[2], 20.25F);
}

TEST(CelsiusDecoder, SaysWhyCountsAreNoTemperatures) {
  const RawThermalImage image = imageOf({1, 2}, NotTemperature{"is of a Vue Pro"});
  EXPECT_EQ(messageOf<DataError>([&] { static_cast<void>(CelsiusDecoder().decode(image, "car.jpg")); }),
            "car.jpg: is of a Vue Pro");
}

TEST(CelsiusDecoder, ReplacesNothingInTemperaturesOfTheCamerasOwnMaking) {
  const RadiometricOverrides overrides{.humidity = 0.9};
  for (const RawThermalImage& image :
       {imageOf({30000}, TLinear{}), RawThermalImage{.width = 1, .height = 1, .celsius = {20.0F}}}) {
    EXPECT_THAT(messageOf<DataError>(
                    [&] { static_cast<void>(CelsiusDecoder().decode(image, "duo.tiff", overrides)); }),
                AllOf(HasSubstr("duo.tiff: "), HasSubstr("expected a file with radiometric parameters")));
  }
}

TEST(CelsiusDecoder, TellsTheUsersImpossibleValuesFromTheFiles) {
  const RawThermalImage good = imageOf({17500}, test::e40());
  EXPECT_THAT(messageOf<ConfigError>(
                  [&] { static_cast<void>(CelsiusDecoder().decode(good, "image", {.emissivity = 1.5})); }),
              HasSubstr("emissivity"));
  RadiometricParameters damaged = test::e40();
  damaged.planck.r1 = kNaN;
  EXPECT_THAT(messageOf<DataError>([&] {
                static_cast<void>(CelsiusDecoder().decode(imageOf({17500}, damaged), "damaged.jpg"));
              }),
              HasSubstr("damaged.jpg: "));
}

TEST(StatisticsOf, CountWhatIsKnownAndWhatLiesOutsideTheRange) {
  const ThermalImage image{.width = 6, .height = 1, .celsius = {-40.0F, -20.0F, kNaN, 0.0F, 120.0F, 121.0F}};
  const ThermalStatistics statistics = statisticsOf(image, CalibratedRange{-20.0, 120.0});
  EXPECT_EQ(statistics.min, -40.0);
  EXPECT_EQ(statistics.max, 121.0);
  EXPECT_NEAR(*statistics.mean, 181.0 / 5.0, 1e-12);
  EXPECT_EQ(statistics.unknown, 1U);
  EXPECT_EQ(statistics.below_range, 1U) << "the ends belong to the range";
  EXPECT_EQ(statistics.above_range, 1U);
}

TEST(StatisticsOf, HaveNoRangeWhereNoneIsKnown) {
  const ThermalStatistics statistics =
      statisticsOf({.width = 1, .height = 1, .celsius = {900.0F}}, std::nullopt);
  EXPECT_EQ(statistics.max, 900.0);
  EXPECT_EQ(statistics.above_range, 0U);
}

TEST(StatisticsOf, AreEmptyWhereNothingIsKnown) {
  const ThermalStatistics nothing =
      statisticsOf({.width = 2, .height = 1, .celsius = {kNaN, std::numeric_limits<float>::infinity()}}, {});
  EXPECT_FALSE(nothing.min || nothing.mean || nothing.max);
  EXPECT_EQ(nothing.unknown, 2U);
  EXPECT_FALSE(statisticsOf({}, {}).mean) << "an image of nothing";
}

}  // namespace
}  // namespace thermovox
