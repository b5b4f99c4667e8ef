#include "projection/time.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace thermovox {
namespace {

std::optional<std::int64_t> nanosecondsOf(std::string_view text) {
  const std::optional<Time> time = parseTime(text);
  return time ? std::optional(time->time_since_epoch().count()) : std::nullopt;
}

TEST(ParseTime, KeepsEveryNanosecondOfDecimalText) {
  EXPECT_EQ(nanosecondsOf("1700000000.199999809"), 1'700'000'000'199'999'809);
  EXPECT_EQ(nanosecondsOf("1700000000.000000001"), 1'700'000'000'000'000'001);
  EXPECT_EQ(nanosecondsOf("32.9"), 32'900'000'000);
  EXPECT_EQ(nanosecondsOf("0"), 0);
  EXPECT_EQ(nanosecondsOf("5."), 5'000'000'000);
  EXPECT_EQ(nanosecondsOf(".25"), 250'000'000);
  EXPECT_EQ(nanosecondsOf("007.5"), 7'500'000'000);
}

TEST(ParseTime, RoundsTheTenthDecimal) {
  EXPECT_EQ(nanosecondsOf("1.0000000004"), 1'000'000'000);
  EXPECT_EQ(nanosecondsOf("1.0000000005"), 1'000'000'001);
  EXPECT_EQ(nanosecondsOf("1.99999999951"), 2'000'000'000);
  EXPECT_EQ(nanosecondsOf("-1.0000000005"), -1'000'000'001);
}

TEST(ParseTime, ReadsNegativeStamps) {
  EXPECT_EQ(nanosecondsOf("-0.5"), -500'000'000);
  EXPECT_EQ(nanosecondsOf("-1700000000.199999809"), -1'700'000'000'199'999'809);
  EXPECT_EQ(nanosecondsOf("-0"), 0);
}

TEST(ParseTime, ReadsExponents) {
  EXPECT_EQ(nanosecondsOf("1.7e9"), 1'700'000'000'000'000'000);
  EXPECT_EQ(nanosecondsOf("1.7E+9"), 1'700'000'000'000'000'000);
  EXPECT_EQ(nanosecondsOf("25e-1"), 2'500'000'000);
  EXPECT_EQ(nanosecondsOf("-1e-9"), -1);
  EXPECT_EQ(nanosecondsOf("0e999"), 0);
  EXPECT_EQ(nanosecondsOf("1e-999"), 0);
}

// numpy.savetxt writes stamps in this form unless told otherwise; a double would be 191 ns off.
TEST(ParseTime, KeepsEveryNanosecondOfAnExponentToo) {
  EXPECT_EQ(nanosecondsOf("1.700000000199999809e+09"), 1'700'000'000'199'999'809);
  EXPECT_EQ(nanosecondsOf("1700000000199999809e-9"), 1'700'000'000'199'999'809);
  EXPECT_EQ(nanosecondsOf("0.000001700000000199999809e15"), 1'700'000'000'199'999'809);
}

TEST(ParseTime, RefusesWhat64BitNanosecondsCannotHold) {
  for (const char* text :
       {"9300000000", "-9300000000", "1e10", "9.3e9", "1e999", "99999999999999999999999999",
        "123456789012345678901234567890.5", "1e99999999999999999999"}) {
    EXPECT_EQ(nanosecondsOf(text), std::nullopt) << text;
  }
  EXPECT_EQ(nanosecondsOf("4599999999.999999999"), 4'599'999'999'999'999'999);
}

TEST(ParseTime, RefusesWhatIsNotOneNumber) {
  for (const char* text : {"",         "-",     "+",     ".",   "-.",  "e9",    ".e3",      "1e",  "1e+",
                           "1e5x",     "1.2.3", "1 2",   " 1",  "1 ",  "1,5",   "nan",      "inf", "-inf",
                           "infinity", "0x10",  "1e2.5", "--1", "-+1", "1_000", "timestamp"}) {
    EXPECT_EQ(nanosecondsOf(text), std::nullopt) << '"' << text << '"';
  }
  EXPECT_EQ(nanosecondsOf(std::string_view("1\0", 2)), std::nullopt);
}

TEST(FormatTime, WritesNineDecimals) {
  EXPECT_EQ(formatTime(Time(Duration(1'700'000'000'000'000'001))), "1700000000.000000001");
  EXPECT_EQ(formatTime(Time(Duration(0))), "0.000000000");
  EXPECT_EQ(formatTime(Time(Duration(-1))), "-0.000000001");
  EXPECT_EQ(formatTime(Time(Duration(std::numeric_limits<std::int64_t>::min()))), "-9223372036.854775808");
}

TEST(FormatTime, ReadsBackAsTheSameTime) {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<std::int64_t> stamp(-4'600'000'000'000'000'000, 4'600'000'000'000'000'000);
  for (int i = 0; i < 10'000; ++i) {
    const Time time{Duration(stamp(random))};
    EXPECT_EQ(parseTime(formatTime(time)), time) << formatTime(time);
  }
}

TEST(Duration, OfSecondsRoundsToTheNanosecond) {
  EXPECT_EQ(durationFromSeconds(0.1), Duration(100'000'000));
  EXPECT_EQ(durationFromSeconds(1.736e-5), Duration(17'360));
  EXPECT_EQ(durationFromSeconds(-0.25), Duration(-250'000'000));
  EXPECT_DOUBLE_EQ(toSeconds(Duration(1'500'000'000)), 1.5);
  EXPECT_DOUBLE_EQ(toUnixSeconds(Time(Duration(1'700'000'000'250'000'000))), 1'700'000'000.25);
}

}  // namespace
}  // namespace thermovox
