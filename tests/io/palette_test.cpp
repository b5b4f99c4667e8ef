#include "io/palette.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace thermovox {
namespace {

constexpr Palette kPalettes[] = {Palette::inferno, Palette::magma,   Palette::viridis, Palette::cividis,
                                 Palette::ironbow, Palette::rainbow, Palette::grey,    Palette::black_hot};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(Palette, NeverShowsTheWhiteThatOctomapTakesForUnset) {
  for (const Palette palette : kPalettes) {
    for (int i = -100; i <= 2100; ++i) EXPECT_NE(colourAt(palette, i / 2000.0), (Rgb{255, 255, 255}));
  }
}

TEST(Palette, EndsHoldBeyondTheSpanAndNanIsGrey) {
  for (const Palette palette : kPalettes) {
    EXPECT_EQ(colourOf(-40.0, {10.0, 20.0}, palette), colourOf(10.0, {10.0, 20.0}, palette));
    EXPECT_EQ(colourOf(90.0, {10.0, 20.0}, palette), colourOf(20.0, {10.0, 20.0}, palette));
    EXPECT_NE(colourOf(10.0, {10.0, 20.0}, palette), colourOf(20.0, {10.0, 20.0}, palette));
    EXPECT_EQ(colourOf(std::nan(""), {10.0, 20.0}, palette), kUnknownColour);
  }
}

TEST(Palette, MarksOfUncalibratedTemperaturesAreLikeNoColourOfIt) {
  const auto distance = [](const Rgb& a, const Rgb& b) {
    return std::hypot(a.r - b.r, a.g - b.g, a.b - b.b);
  };
  for (const Palette palette : kPalettes) {
    const auto [below, above] = uncalibratedColours(palette);
    constexpr double kClearly = 60.0;  // of 441 from black to white
    EXPECT_GT(distance(below, above), kClearly);
    for (const Rgb& mark : {below, above}) {
      EXPECT_GT(distance(mark, kUnknownColour), kClearly);
      for (int i = 0; i <= 1000; ++i) ASSERT_GT(distance(mark, colourAt(palette, i / 1000.0)), kClearly) << i;
    }
  }
}

TEST(Palette, ColoursChangeInSmallSteps) {
  for (const Palette palette : kPalettes) {
    for (int i = 0; i < 1000; ++i) {
      const Rgb a = colourAt(palette, i / 1000.0);
      const Rgb b = colourAt(palette, (i + 1) / 1000.0);
      EXPECT_LE(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), 6);
    }
  }
}

TEST(Palette, AllButRainbowAndBlackHotGrowBrighter) {
  for (const Palette palette : {Palette::inferno, Palette::magma, Palette::viridis, Palette::cividis,
                                Palette::ironbow, Palette::grey}) {
    double previous = -1.0;
    for (int i = 0; i <= 50; ++i) {
      const Rgb c = colourAt(palette, i / 50.0);
      const double luminance = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
      EXPECT_GT(luminance, previous);
      previous = luminance;
    }
  }
}

TEST(Palette, NamesAreThoseOfTheCommandLine) {
  EXPECT_EQ(paletteOf("inferno"), Palette::inferno);
  EXPECT_EQ(paletteOf("ironbow"), Palette::ironbow);
  EXPECT_EQ(paletteOf("rainbow"), Palette::rainbow);
  EXPECT_EQ(paletteOf("grey"), Palette::grey);
  EXPECT_FALSE(paletteOf("Inferno"));
  EXPECT_EQ(namedPalettes().size(), std::size(kPalettes));
  for (const auto& [name, palette] : namedPalettes()) EXPECT_EQ(paletteOf(name), palette);
}

TEST(PercentileSpan, LeavesOutNanAndTheTails) {
  std::vector<float> celsius{kNan};
  for (int i = 100; i >= 0; --i) celsius.push_back(static_cast<float>(i));
  EXPECT_EQ(percentileSpan(celsius), (TemperatureSpan{2.0, 98.0}));
  EXPECT_EQ(percentileSpan(celsius, 0.0, 100.0), (TemperatureSpan{0.0, 100.0}));
  const std::vector<float> two{10.0F, 20.0F};
  EXPECT_EQ(percentileSpan(two, 25.0, 75.0), (TemperatureSpan{12.5, 17.5}));
}

TEST(PercentileSpan, HasAWidthEvenForOneTemperatureAndNoneForNothing) {
  const std::vector<float> same{0.0F, 0.0F, 0.0F};
  EXPECT_EQ(percentileSpan(same), (TemperatureSpan{-0.5, 0.5}));
  const std::vector<float> unknown{kNan, kNan};
  EXPECT_FALSE(percentileSpan(unknown));
  EXPECT_FALSE(percentileSpan({}));
}

}  // namespace
}  // namespace thermovox
