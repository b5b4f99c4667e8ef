#include "projection/laser/range_finder.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace thermovox {
namespace {

constexpr Time kStamp{Duration(1'700'000'000'123'456'789)};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Laser beamLaser() {
  return Laser{.kind = LaserKind::beam, .range_min = 0.2, .range_max = 40.0, .min_intensity = 50.0};
}

TEST(RangeFinder, MeasuresAlongPlusX) {
  const Reading reading = readingFromBeam({kStamp, 7.25, 80.0F}, beamLaser());
  ASSERT_EQ(reading.returns.size(), 1U);
  EXPECT_EQ(reading.stamp, kStamp);
  EXPECT_EQ(reading.returns[0].stamp, kStamp);
  EXPECT_EQ(reading.returns[0].p_laser, Eigen::Vector3d(7.25, 0.0, 0.0));
  EXPECT_EQ(reading.returns[0].range(), 7.25);
  EXPECT_EQ(reading.returns[0].intensity, 80.0F);
  EXPECT_EQ(reading.dropped.total(), 0U);
}

TEST(RangeFinder, CountsWhatCameBackFromNothing) {
  for (const double range : {kNan, kInfinity, -kInfinity, 0.0, -0.0, -1.0, -7.0}) {
    const Reading reading = readingFromBeam({kStamp, range, 80.0F}, beamLaser());
    EXPECT_TRUE(reading.returns.empty()) << range;
    EXPECT_EQ(reading.dropped.no_return, 1U) << range;
    EXPECT_EQ(reading.dropped.total(), 1U) << range;
  }
}

TEST(RangeFinder, CountsWhatIsOutsideItsSpanByReason) {
  EXPECT_EQ(readingFromBeam({kStamp, 0.19, 80.0F}, beamLaser()).dropped.too_near, 1U);
  EXPECT_EQ(readingFromBeam({kStamp, 40.01, 80.0F}, beamLaser()).dropped.too_far, 1U);
  EXPECT_EQ(readingFromBeam({kStamp, 5.0, 49.0F}, beamLaser()).dropped.too_weak, 1U);
}

TEST(RangeFinder, KeepsTheLimitsThemselves) {
  EXPECT_EQ(readingFromBeam({kStamp, 0.2, 50.0F}, beamLaser()).returns.size(), 1U);
  EXPECT_EQ(readingFromBeam({kStamp, 40.0, 50.0F}, beamLaser()).returns.size(), 1U);
}

TEST(RangeFinder, TakesAnUnknownStrengthForGood) {
  EXPECT_EQ(readingFromBeam({.stamp = kStamp, .range = 5.0}, beamLaser()).returns.size(), 1U);
}

TEST(DroppedReturns, AddUpReasonByReason) {
  DroppedReturns sum{.no_return = 1, .too_near = 2, .too_far = 3, .too_weak = 4};
  sum += {.no_return = 10, .too_near = 20, .too_far = 30, .too_weak = 40};
  EXPECT_EQ(sum.no_return, 11U);
  EXPECT_EQ(sum.too_near, 22U);
  EXPECT_EQ(sum.too_far, 33U);
  EXPECT_EQ(sum.too_weak, 44U);
  EXPECT_EQ(sum.total(), 110U);
}

}  // namespace
}  // namespace thermovox
