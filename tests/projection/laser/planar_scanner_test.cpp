#include "projection/laser/planar_scanner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/projection/matchers.hpp"

namespace thermovox {
namespace {

using test::IsNear;

constexpr Time kStamp{Duration(1'700'000'000'123'456'789)};

/// Five beams from -90 to +90 degrees, 25 us apart.
Laser scanner() {
  return Laser{.kind = LaserKind::scan,
               .range_min = 0.1,
               .range_max = 30.0,
               .angle_min = -M_PI / 2,
               .angle_increment = M_PI / 4,
               .time_increment = std::chrono::microseconds(25)};
}

TEST(PlanarScanner, CountsAnglesFromPlusXCounterClockwise) {
  const std::vector<float> ranges{1, 2, 3, 4, 5};
  const Reading reading = readingFromScan(kStamp, ranges, scanner());
  ASSERT_EQ(reading.returns.size(), 5U);
  EXPECT_THAT(reading.returns[0].p_laser, IsNear(Eigen::Vector3d(0, -1, 0), 1e-12));  // right
  EXPECT_THAT(reading.returns[2].p_laser, IsNear(Eigen::Vector3d(3, 0, 0), 1e-12));   // ahead
  EXPECT_THAT(reading.returns[4].p_laser, IsNear(Eigen::Vector3d(0, 5, 0), 1e-12));   // left
  EXPECT_THAT(reading.returns[3].p_laser, IsNear(Eigen::Vector3d(4 * M_SQRT1_2, 4 * M_SQRT1_2, 0), 1e-12));
}

TEST(PlanarScanner, GivesEveryReturnItsOwnTime) {
  const std::vector<float> ranges{1, 2, 0, 4, 5};  // a beam without echo takes its time too
  const Reading reading = readingFromScan(kStamp, ranges, scanner());
  ASSERT_EQ(reading.returns.size(), 4U);
  EXPECT_EQ(reading.stamp, kStamp);
  EXPECT_EQ(reading.returns[0].stamp, kStamp);
  EXPECT_EQ(reading.returns[1].stamp, kStamp + Duration(25'000));
  EXPECT_EQ(reading.returns[2].stamp, kStamp + Duration(75'000));
  EXPECT_EQ(reading.returns[3].stamp, kStamp + Duration(100'000));
}

TEST(PlanarScanner, KeepsTheRangeAsTheLaserReadIt) {
  for (int i = 0; i < 1000; ++i) {
    Laser laser = scanner();
    laser.angle_min = -3.0 + 0.006 * i;
    const float range = 0.2F + 0.0297F * static_cast<float>(i);
    const Reading reading = readingFromScan(kStamp, std::vector<float>{range}, laser);
    ASSERT_EQ(reading.returns.size(), 1U);
    EXPECT_DOUBLE_EQ(reading.returns[0].range(), range);
  }
}

TEST(PlanarScanner, DropsByReason) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> ranges{kNan, kInfinity, -kInfinity, 0, -1, 0.05F, 31, 60, 2};
  const Reading reading = readingFromScan(kStamp, ranges, scanner());
  EXPECT_EQ(reading.returns.size(), 1U);
  EXPECT_EQ(reading.dropped.no_return, 5U);
  EXPECT_EQ(reading.dropped.too_near, 1U);
  EXPECT_EQ(reading.dropped.too_far, 2U);
  EXPECT_EQ(reading.dropped.too_weak, 0U);
}

TEST(PlanarScanner, OfNoRangesIsAnEmptySweep) {
  const Reading reading = readingFromScan(kStamp, {}, scanner());
  EXPECT_TRUE(reading.returns.empty());
  EXPECT_EQ(reading.dropped.total(), 0U);
}

}  // namespace
}  // namespace thermovox
