#include "mapping/severity.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string nameOf(const SeverityTable& table, SeverityBasis basis, double rise) {
  const SeverityClass* one = table.classOf(basis, rise);
  return one == nullptr ? "none" : one->name;
}

TEST(Severity, NetasClassesHoldTheirUpperLimitAndHaveNoGaps) {
  struct Case {
    double rise;
    const char* over_ambient;
    const char* over_similar;
  };
  const double just = 1e-9;
  for (const Case& one : {Case{just, "possible", "possible"}, Case{1.0, "possible", "possible"},
                          Case{3.0, "possible", "possible"}, Case{3.0 + just, "possible", "probable"},
                          Case{3.5, "possible", "probable"}, Case{10.0, "possible", "probable"},
                          Case{10.0 + just, "probable", "probable"}, Case{15.0, "probable", "probable"},
                          Case{15.0 + just, "probable", "major"}, Case{20.0, "probable", "major"},
                          Case{20.0 + just, "monitor", "major"}, Case{40.0, "monitor", "major"},
                          Case{40.0 + just, "major", "major"}, Case{1e9, "major", "major"},
                          Case{kInfinity, "major", "major"}}) {
    SCOPED_TRACE(one.rise);
    EXPECT_EQ(nameOf(netaSeverity(), SeverityBasis::over_ambient, one.rise), one.over_ambient);
    EXPECT_EQ(nameOf(netaSeverity(), SeverityBasis::over_similar, one.rise), one.over_similar);
  }
}

TEST(Severity, WhatIsNoRiseHasNoClass) {
  for (const double rise : {0.0, -0.0, -5.0, -kInfinity, std::nan("")}) {
    EXPECT_EQ(nameOf(netaSeverity(), SeverityBasis::over_ambient, rise), "none") << rise;
  }
}

TEST(Severity, ATableMayLackABasis) {
  SeverityTable table = netaSeverity();
  table.over_similar.clear();
  table.validate();
  EXPECT_EQ(nameOf(table, SeverityBasis::over_similar, 30.0), "none");
  table.over_ambient.clear();
  EXPECT_THROW(table.validate(), ConfigError);
}

TEST(Severity, NetasTableIsSoundAndNamesItsEdition) {
  netaSeverity().validate();
  EXPECT_EQ(netaSeverity().edition, "2019");
}

TEST(Severity, RefusesLimitsThatDoNotAscendOrLeaveAnEnd) {
  for (const double first : {0.0, -1.0, 20.0, 25.0, kInfinity, std::nan("")}) {
    SeverityTable table = netaSeverity();
    table.over_ambient[0].up_to = first;
    EXPECT_THROW(table.validate(), ConfigError) << first;
  }
  for (const double last : {50.0, 30.0, std::nan("")}) {
    SeverityTable table = netaSeverity();
    table.over_ambient.back().up_to = last;
    EXPECT_THROW(table.validate(), ConfigError) << last;
  }
}

TEST(Severity, RefusesClassesWithoutANameOfTheirOwn) {
  SeverityTable table = netaSeverity();
  table.over_similar[1].name = "possible";
  EXPECT_THROW(table.validate(), ConfigError);
  table.over_similar[1].name.clear();
  EXPECT_THROW(table.validate(), ConfigError);
}

}  // namespace
}  // namespace thermovox
