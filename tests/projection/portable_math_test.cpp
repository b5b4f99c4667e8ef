#include "projection/portable_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace thermovox {
namespace {

constexpr int kTries = 200000;
constexpr double kRelative = 4.5e-16;  // two units in the last place: what the header says

TEST(PortableExp, AgreesWithTheCLibraryToTheLastBits) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> wide(-700.0, 700.0), narrow(-1.0, 1.0);
  for (int i = 0; i < kTries; ++i) {
    const double x = i % 2 == 0 ? wide(random) : narrow(random);
    const long double expected = std::exp(static_cast<long double>(x));
    ASSERT_LE(std::abs(portableExp(x) / expected - 1.0L), kRelative) << x;
  }
}

TEST(PortableExp, EndsWhereDoublesEnd) {
  EXPECT_EQ(portableExp(0.0), 1.0);
  EXPECT_EQ(portableExp(-1e6), 0.0);
  EXPECT_EQ(portableExp(1e6), HUGE_VAL);
  EXPECT_EQ(portableExp(HUGE_VAL), HUGE_VAL);
  EXPECT_EQ(portableExp(-HUGE_VAL), 0.0);
  EXPECT_TRUE(std::isnan(portableExp(std::nan(""))));
}

TEST(PortableLog, AgreesWithTheCLibraryToTheLastBits) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-700.0, 700.0), near_one(0.5, 2.0);
  for (int i = 0; i < kTries; ++i) {
    const double x = i % 2 == 0 ? std::exp(exponent(random)) : near_one(random);
    const long double expected = std::log(static_cast<long double>(x));
    ASSERT_LE(std::abs(portableLog(x) - expected), kRelative * std::abs(expected)) << x;
  }
}

TEST(PortableLog, IsOnlyOfPositiveNumbers) {
  EXPECT_EQ(portableLog(1.0), 0.0);
  for (const double x : {0.0, -1.0, -HUGE_VAL, HUGE_VAL, std::nan(""), 1e-320})
    EXPECT_TRUE(std::isnan(portableLog(x))) << x;
}

}  // namespace
}  // namespace thermovox
