#include "projection/placement.hpp"

#include <gtest/gtest.h>

#include <random>

#include "projection/position_covariance.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox {
namespace {

using std::chrono::milliseconds;
using test::IsNear;

constexpr Time kStart{std::chrono::seconds(1'700'000'000)};

/// A body that turns about its own z by 90 degrees a second while it flies 2 m/s along x.
Pose truePose(Time stamp) {
  const double seconds = toSeconds(stamp - kStart);
  return {expRotation({0.0, 0.0, M_PI / 2 * seconds}) * expRotation({0.05, -0.1, 0.0}),
          {2.0 * seconds, 1.0, 1.5}};
}

Mission turningMission() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 20; ++i)
    poses.push_back({kStart + milliseconds(50 * i), truePose(kStart + milliseconds(50 * i))});
  return Mission{.trajectory = Trajectory(std::move(poses))};
}

const Pose kT_body_laser{expRotation({0.2, 0.1, -0.5}), {0.1, 0.05, -0.2}};

LaserReturn returnOf(const Eigen::Vector3d& target_world, Time stamp) {
  return {.stamp = stamp, .p_laser = kT_body_laser.inverse() * (truePose(stamp).inverse() * target_world)};
}

TEST(Place, PutsReturnsOfOneTargetAtDifferentTimesOnOnePlace) {
  const Mission mission = turningMission();
  const Laser laser{.T_body_laser = kT_body_laser};
  const Eigen::Vector3d target(7.0, -3.0, 2.0);
  std::mt19937_64 random(6);
  std::uniform_int_distribution<std::int64_t> nanoseconds(0, 1'000'000'000);
  for (int i = 0; i < 500; ++i) {
    const Time stamp = kStart + Duration(nanoseconds(random));
    const auto placed = place(returnOf(target, stamp), laser, mission);
    ASSERT_TRUE(std::holds_alternative<PlacedReturn>(placed));
    const PlacedReturn& point = std::get<PlacedReturn>(placed);
    // A stamp within 1 us of a pose takes that pose as it is: 2 um of way and 1.6 urad, 14 um at 9 m.
    EXPECT_THAT(point.p_world, IsNear(target, 2e-5)) << formatTime(stamp);
    EXPECT_THAT(point.origin_world, IsNear(truePose(stamp) * kT_body_laser.translation, 1e-5));
    EXPECT_EQ(point.stamp, stamp);
    EXPECT_NEAR(point.range, (target - point.origin_world).norm(), 1e-4);
  }
}

TEST(Place, WithoutDeskewWouldSmearTheTarget) {  // what the test above guards against
  const Mission mission = turningMission();
  const Laser laser{.T_body_laser = kT_body_laser};
  const Eigen::Vector3d target(7.0, -3.0, 2.0);
  LaserReturn late = returnOf(target, kStart + milliseconds(530));
  late.stamp = kStart + milliseconds(500);
  EXPECT_GT((std::get<PlacedReturn>(place(late, laser, mission)).p_world - target).norm(), 0.2);
}

TEST(Place, DropsWhatTheTrajectoryCannotSay) {
  const Mission mission = turningMission();
  const Laser laser{.T_body_laser = kT_body_laser};
  const auto reasonAt = [&](Time stamp) {
    return std::get<NoPose>(place({.stamp = stamp, .p_laser = {1, 0, 0}}, laser, mission));
  };
  EXPECT_EQ(reasonAt(kStart - milliseconds(1)), NoPose::before_start);
  EXPECT_EQ(reasonAt(kStart + milliseconds(1001)), NoPose::after_end);
  const Mission sparse{.trajectory =
                           Trajectory({{kStart, truePose(kStart)},
                                       {kStart + milliseconds(900), truePose(kStart + milliseconds(900))}})};
  EXPECT_EQ(
      std::get<NoPose>(place({.stamp = kStart + milliseconds(400), .p_laser = {1, 0, 0}}, laser, sparse)),
      NoPose::gap);
}

TEST(Place, SplitsTheCovarianceIntoWhatMovesThePointInTheImageAndWhatDoesNot) {
  Mission mission = turningMission();
  mission.pose_rotation_sigma = 0.002;
  mission.pose_translation_sigma = 0.01;
  Laser laser{.T_body_laser = kT_body_laser, .range_sigma = 0.02, .range_bias_sigma = 0.01};
  laser.covariance_body_laser = 1e-5 * Matrix6d::Identity();
  const Time stamp = kStart + milliseconds(123);
  const LaserReturn echo{.stamp = stamp, .p_laser = {5, 1, -1}};
  const PlacedReturn point = std::get<PlacedReturn>(place(echo, laser, mission));
  const PositionCovariance expected = positionCovariance(mission, laser, truePose(stamp), echo.p_laser);
  const double rounding = 1e-10;  // of single precision, for entries up to 1e-3
  EXPECT_THAT(point.rig_covariance.matrix(),
              IsNear(Eigen::Matrix3d(expected.random + expected.extrinsic), rounding));
  EXPECT_THAT(point.pose_covariance.matrix(), IsNear(expected.pose, rounding));
  EXPECT_THAT(point.positionCovariance(), IsNear(expected.total(), rounding));
}

}  // namespace
}  // namespace thermovox
