#include "projection/celsius_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "projection/error.hpp"
#include "tests/support/radiometry.hpp"

namespace thermovox {
namespace {

using test::sc660;

std::vector<std::uint16_t> everyCount() {
  std::vector<std::uint16_t> counts(65536);
  std::iota(counts.begin(), counts.end(), std::uint16_t{0});
  return counts;
}

void expectTheFormula(CelsiusTable& table, const std::vector<std::uint16_t>& counts) {
  std::vector<float> celsius(counts.size());
  table.convert(counts, celsius);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto expected = static_cast<float>(celsiusOfCounts(counts[i], table.parameters()));
    if (std::isnan(expected)) {
      ASSERT_TRUE(std::isnan(celsius[i])) << counts[i];
    } else {
      ASSERT_EQ(celsius[i], expected) << counts[i];
    }
  }
}

TEST(CelsiusTable, IsTheFormulaForEveryCount) {
  CelsiusTable table(sc660());
  expectTheFormula(table, everyCount());
}

TEST(CelsiusTable, GrowsToAnyCountsInAnyOrder) {
  std::mt19937_64 random(4);
  CelsiusTable table(sc660());
  for (int frame = 0; frame < 30; ++frame) {
    const auto middle = static_cast<int>(random() % 65536);
    std::uniform_int_distribution<int> count(std::max(0, middle - 500), std::min(65535, middle + 500));
    std::vector<std::uint16_t> counts(300);
    for (std::uint16_t& value : counts) value = static_cast<std::uint16_t>(count(random));
    expectTheFormula(table, counts);
  }
  expectTheFormula(table, everyCount());
}

TEST(CelsiusTable, AcceptsAnImageOfNothing) {
  CelsiusTable table(sc660());
  table.convert({}, {});
}

TEST(CelsiusTable, RefusesParametersThatCannotBe) {
  RadiometricParameters parameters = sc660();
  parameters.emissivity = 0.0;
  EXPECT_THROW(CelsiusTable{parameters}, ConfigError);
}

}  // namespace
}  // namespace thermovox
