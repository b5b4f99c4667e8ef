#include "projection/laser/multi_beam.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace thermovox {
namespace {

constexpr Time kStamp{Duration(1'700'000'000'123'456'789)};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Laser cloudLaser() {
  return Laser{.kind = LaserKind::cloud, .range_min = 0.5, .range_max = 50.0, .min_intensity = 10.0};
}

TEST(MultiBeam, KeepsPointsInTheirOrderWithTheirOwnTimes) {
  const std::vector<CloudPoint> points{
      {{1, 2, 3}, 20.0F, 0.0}, {{-4, 5, -6}, kNan, 0.05}, {{7, 8, 9}, 30.0F, -0.001}};
  const Reading reading = readingFromCloud(kStamp, points, cloudLaser());
  ASSERT_EQ(reading.returns.size(), 3U);
  EXPECT_EQ(reading.stamp, kStamp);
  EXPECT_EQ(reading.returns[0].p_laser, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(reading.returns[0].stamp, kStamp);
  EXPECT_EQ(reading.returns[1].p_laser, Eigen::Vector3d(-4, 5, -6));
  EXPECT_EQ(reading.returns[1].stamp, kStamp + Duration(50'000'000));
  EXPECT_EQ(reading.returns[2].stamp, kStamp - Duration(1'000'000));
  EXPECT_EQ(reading.returns[2].intensity, 30.0F);
}

TEST(MultiBeam, DropsByReason) {
  const std::vector<CloudPoint> points{
      {{kNan, 1, 1}, 20.0F},       {{1, kInfinity, 1}, 20.0F},
      {{0, 0, 0}, 20.0F},                                           // no return
      {{0.1F, 0.2F, 0.3F}, 20.0F},                                  // too near
      {{40, 40, 0}, 20.0F},        {{3e38F, 3e38F, 3e38F}, 20.0F},  // too far
      {{1, 1, 1}, 9.0F},                                            // too weak
      {{1, 1, 1}, 10.0F},          {{1, 1, 1}, kNan},               // good
  };
  const Reading reading = readingFromCloud(kStamp, points, cloudLaser());
  EXPECT_EQ(reading.returns.size(), 2U);
  EXPECT_EQ(reading.dropped.no_return, 3U);
  EXPECT_EQ(reading.dropped.too_near, 1U);
  EXPECT_EQ(reading.dropped.too_far, 2U);
  EXPECT_EQ(reading.dropped.too_weak, 1U);
}

TEST(MultiBeam, DropsATimeThatCannotBe) {
  for (const double time : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                            1.7e9, -1e300, 11.0, -11.0}) {
    const Reading reading =
        readingFromCloud(kStamp, std::vector<CloudPoint>{{{1, 2, 3}, 20.0F, time}}, cloudLaser());
    EXPECT_TRUE(reading.returns.empty()) << time;
    EXPECT_EQ(reading.dropped.bad_time, 1U) << time;
  }
}

}  // namespace
}  // namespace thermovox
