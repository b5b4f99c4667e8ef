#include "projection/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "projection/error.hpp"
#include "tests/projection/matchers.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::IsNear;
using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

constexpr Time kStart{std::chrono::seconds(1'700'000'000)};

Pose yawed(double angle, const Eigen::Vector3d& translation) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())), translation};
}

/// Two poses 0.4 s apart: 60 degrees of yaw and 2 m of way between them.
Trajectory quarterTurn() {
  return Trajectory(
      {{kStart, yawed(0.2, {1, 2, 3})}, {kStart + milliseconds(400), yawed(0.2 + M_PI / 3, {1, 4, 3})}});
}

TEST(Trajectory, TurnsAtAConstantRateAndMovesAlongALineBetweenPoses) {
  const Trajectory trajectory = quarterTurn();
  for (int ms = 0; ms <= 400; ++ms) {
    const auto at = trajectory.at(kStart + milliseconds(ms));
    ASSERT_TRUE(std::holds_alternative<Pose>(at)) << ms;
    const Pose expected = yawed(0.2 + ms / 400.0 * M_PI / 3, {1, 2 + ms / 200.0, 3});
    EXPECT_THAT(std::get<Pose>(at).matrix(), IsNear(expected.matrix(), 1e-12)) << ms;
    EXPECT_THAT(std::get<Pose>(at).translation, IsNear(expected.translation, 1e-12)) << ms;
  }
}

// The formula of slerp (Shoemake 1985), not Eigen's: (sin((1 - f) w) a + sin(f w) b) / sin(w).
TEST(Trajectory, AgreesWithTheFormulaOfSlerpOnRandomPoses) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const auto draw = [&] {
      return Eigen::Vector4d(normal(random), normal(random), normal(random), normal(random)).normalized();
    };
    const Eigen::Vector4d a = draw();
    const Eigen::Vector4d b = draw();
    const auto fraction_ns = static_cast<std::int64_t>(uniform(random) * 1e8);
    const Trajectory trajectory(
        {{kStart, {Eigen::Quaterniond(a), Eigen::Vector3d(i, 0, 0)}},
         {kStart + milliseconds(100), {Eigen::Quaterniond(b), Eigen::Vector3d(0, i, 1)}}});
    const double f = static_cast<double>(fraction_ns) / 1e8;
    const Eigen::Vector4d short_way = a.dot(b) < 0.0 ? Eigen::Vector4d(-b) : b;
    const double w = std::acos(std::min(1.0, a.dot(short_way)));
    const Eigen::Vector4d expected = (std::sin((1 - f) * w) * a + std::sin(f * w) * short_way) / std::sin(w);
    const Pose pose = std::get<Pose>(trajectory.at(kStart + Duration(fraction_ns)));
    // A stamp within 1 us of a pose takes that pose: up to 1e-5 of the way, hence the tolerance.
    EXPECT_THAT(pose.matrix(), IsNear(Eigen::Quaterniond(expected).toRotationMatrix(), 1e-4)) << i;
    EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-14);
    if (f > 2e-5 && f < 1 - 2e-5) {
      EXPECT_THAT(pose.matrix(), IsNear(Eigen::Quaterniond(expected).toRotationMatrix(), 1e-9)) << i;
      EXPECT_THAT(pose.translation, IsNear(Eigen::Vector3d((1 - f) * i, f * i, f), 1e-9)) << i;
    }
  }
}

TEST(Trajectory, NeverExtrapolates) {
  const Trajectory trajectory = quarterTurn();
  const Time end = kStart + milliseconds(400);
  EXPECT_EQ(std::get<NoPose>(trajectory.at(kStart - microseconds(2))), NoPose::before_start);
  EXPECT_EQ(std::get<NoPose>(trajectory.at(end + microseconds(2))), NoPose::after_end);
  EXPECT_EQ(std::get<NoPose>(Trajectory().at(kStart)), NoPose::before_start);
}

TEST(Trajectory, NeverExtrapolatesHoweverFarTheStampIs) {
  const Time earliest{Duration(-9'200'000'000'000'000'000)};
  const Time latest{Duration(9'200'000'000'000'000'000)};
  EXPECT_EQ(std::get<NoPose>(quarterTurn().at(earliest)), NoPose::before_start);
  EXPECT_EQ(std::get<NoPose>(quarterTurn().at(latest)), NoPose::after_end);
  const Trajectory ages({{earliest, yawed(0, {0, 0, 0})}, {latest, yawed(1, {1, 0, 0})}});
  EXPECT_EQ(std::get<NoPose>(ages.at(kStart)), NoPose::gap);
}

TEST(Trajectory, GivesAPoseWithinAMicrosecondOfItWhateverTheGap) {
  const Trajectory trajectory({{kStart, yawed(0.1, {1, 0, 0})},
                               {kStart + std::chrono::seconds(60), yawed(0.5, {2, 0, 0})},
                               {kStart + std::chrono::seconds(120), yawed(0.9, {3, 0, 0})}});
  for (const StampedPose& pose : trajectory.poses()) {
    for (const Duration off : {Duration(-1000), Duration(-1), Duration(0), Duration(1), Duration(1000)}) {
      const auto at = trajectory.at(pose.stamp + off);
      ASSERT_TRUE(std::holds_alternative<Pose>(at))
          << formatTime(pose.stamp) << " and " << off.count() << " ns";
      EXPECT_TRUE(std::get<Pose>(at) == pose.T_world_body);
    }
  }
  EXPECT_EQ(std::get<NoPose>(trajectory.at(kStart + Duration(1001))), NoPose::gap);
  EXPECT_EQ(std::get<NoPose>(trajectory.at(kStart + std::chrono::seconds(60) - Duration(1001))), NoPose::gap);
}

TEST(Trajectory, ReachesAcrossAGapOfTheLimitAndNoFurther) {
  const auto withInterval = [](Duration interval) {
    return Trajectory({{kStart, yawed(0, {0, 0, 0})}, {kStart + interval, yawed(1, {1, 0, 0})}},
                      milliseconds(300));
  };
  EXPECT_TRUE(std::holds_alternative<Pose>(withInterval(milliseconds(300)).at(kStart + milliseconds(150))));
  EXPECT_EQ(std::get<NoPose>(withInterval(milliseconds(300) + Duration(1)).at(kStart + milliseconds(150))),
            NoPose::gap);
  EXPECT_EQ(Trajectory::kDefaultMaxGap, milliseconds(500));
}

TEST(Trajectory, StandsStillAcrossAGapBetweenEqualPoses) {
  const Pose pose = yawed(0.7, {4, 5, 6});
  const Eigen::Quaterniond negated(-pose.rotation.coeffs());  // the same rotation
  for (const Eigen::Quaterniond& rotation : {pose.rotation, negated}) {
    const Trajectory trajectory(
        {{kStart, pose}, {kStart + std::chrono::hours(2), {rotation, pose.translation}}});
    const auto at = trajectory.at(kStart + std::chrono::hours(1));
    ASSERT_TRUE(std::holds_alternative<Pose>(at));
    EXPECT_TRUE(std::get<Pose>(at) == pose);
  }
}

TEST(Trajectory, DoesNotStandStillBetweenPosesThatDifferOnlyInRotation) {
  const Trajectory trajectory(
      {{kStart, yawed(0.7, {4, 5, 6})}, {kStart + std::chrono::hours(2), yawed(0.8, {4, 5, 6})}});
  EXPECT_EQ(std::get<NoPose>(trajectory.at(kStart + std::chrono::hours(1))), NoPose::gap);
}

TEST(Trajectory, TakesTheShortWayBetweenOppositeQuaternions) {
  const Pose start = yawed(0.0, {0, 0, 0});
  Pose end = yawed(0.2, {0, 0, 0});
  end.rotation.coeffs() *= -1.0;
  const Trajectory trajectory({{kStart, start}, {kStart + milliseconds(100), end}});
  EXPECT_THAT(std::get<Pose>(trajectory.at(kStart + milliseconds(50))).matrix(),
              IsNear(yawed(0.1, {0, 0, 0}).matrix(), 1e-12));
}

TEST(Trajectory, RefusesUnsortedAndDuplicateStampsAndNamesThePose) {
  const auto withSecondAt = [](Duration offset) {
    return Trajectory(
        {{kStart, {}}, {kStart + milliseconds(10), {}}, {kStart + milliseconds(10) + offset, {}}});
  };
  EXPECT_NO_THROW((void)withSecondAt(Duration(1)));
  const std::string duplicate = messageOf<DataError>([&] { (void)withSecondAt(Duration(0)); });
  EXPECT_THAT(duplicate, AllOf(HasSubstr("pose 2"), HasSubstr("1700000000.010000000")));
  EXPECT_THAT(messageOf<DataError>([&] { (void)withSecondAt(Duration(-1)); }),
              HasSubstr("1700000000.009999999"));
}

TEST(Trajectory, RefusesAGapLimitThatIsNotPositive) {
  EXPECT_THAT(messageOf<ConfigError>([] { Trajectory({}, Duration::zero()); }), HasSubstr("max_gap"));
  EXPECT_THROW(Trajectory({}, milliseconds(-1)), ConfigError);
}

TEST(Trajectory, OfOnePoseKnowsThatMomentOnly) {
  const Trajectory trajectory({{kStart, yawed(1, {1, 2, 3})}});
  EXPECT_TRUE(std::holds_alternative<Pose>(trajectory.at(kStart)));
  EXPECT_EQ(std::get<NoPose>(trajectory.at(kStart + milliseconds(1))), NoPose::after_end);
  EXPECT_EQ(std::get<NoPose>(trajectory.at(kStart - milliseconds(1))), NoPose::before_start);
}

}  // namespace
}  // namespace thermovox
