#include "calibration/laser_start.hpp"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

constexpr std::array<LaserKind, 3> kKinds{LaserKind::beam, LaserKind::scan, LaserKind::cloud};
const Eigen::Vector2d kPlate(0.60, 0.42);

/// Sights of a scene whose boards the images have a little wrong. Every third has a wall for its likeliest
/// candidate.
std::vector<LaserSight> sightsOf(const BundleScene& scene) {
  Chance chance(scene.seed + 100);
  std::vector<LaserSight> sights;
  for (std::size_t i = 0; i < scene.captures; ++i) {
    LaserSight sight{moved(scene.truth.T_reference_board[i], chance, 0.3 * kDegree, 0.002), {}};
    if (i % 3 == 2) {
      const Pose wall{expRotation({0.0, 0.1, 0.0}), {0.3, 0.0, 3.0}};
      ReturnSet returns;
      for (const Eigen::Vector3d& ray : raysOf(scene.kind)) {
        const auto range = rangeOfPlate(ray, scene.truth.T_reference_laser.inverse() * wall, scene.board);
        if (range || scene.kind == LaserKind::beam) returns.emplace_back(range.value_or(3.0) * ray);
      }
      if (const auto moments = planeMoments(returns, scene.kind, 0.01)) sight.candidates.push_back(*moments);
    }
    sight.candidates.push_back(scene.data.captures[i].plane.value());
    sights.push_back(std::move(sight));
  }
  return sights;
}

double pointingApart(LaserKind kind, const Pose& a, const Pose& b) {
  if (kind != LaserKind::beam) return a.rotation.angularDistance(b.rotation);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  return std::acos(std::min(1.0, (a.rotation * x).dot(b.rotation * x)));
}

BundleScene sceneOf(LaserKind kind, std::uint64_t seed) {
  const std::size_t captures = kind == LaserKind::beam ? 24 : 12;
  return made(
      {.kind = kind, .captures = captures, .range_sigma = 0.008, .range_bias_sigma = 0.004, .seed = seed});
}

void expectFound(LaserKind kind, std::uint64_t seed, const Pose& guess) {
  const BundleScene scene = sceneOf(kind, seed);
  const std::vector<LaserSight> sights = sightsOf(scene);
  const auto start = startLaser(sights, kind, guess, kPlate);
  ASSERT_TRUE(start);
  const Pose& truth = scene.truth.T_reference_laser;
  // Boards are off by 0.3 degrees and 2 mm, ranges by 4 mm: a dozen captures leave about a degree and a
  // centimetre, of a beam (five unknowns of two dozen numbers) twice that. The bundle wants ten degrees.
  const double share = kind == LaserKind::beam ? 2.0 : 1.0;
  EXPECT_LT(pointingApart(kind, start->T_reference_laser, truth), share * 1.5 * kDegree);
  EXPECT_THAT(start->T_reference_laser.translation, IsNear(truth.translation, share * 0.02));
  EXPECT_FALSE(start->rival);
  ASSERT_EQ(start->chosen.size(), sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i)
    EXPECT_EQ(start->chosen[i], sights[i].candidates.size() - 1) << "the board, not the wall";
}

TEST(StartLaser, FindsTheLaserWithoutAGuess) {
  for (const LaserKind kind : kKinds) {
    SCOPED_TRACE(testing::Message() << dimensionsOf(kind) << "D");
    expectFound(kind, 1, Pose{});
  }
}

TEST(StartLaser, FindsTheLaserFromAGuessThatIsAHundredDegreesOff) {
  for (const LaserKind kind : kKinds) {
    SCOPED_TRACE(testing::Message() << dimensionsOf(kind) << "D");
    Pose guess = laserBesideCamera();
    guess.rotation =
        guess.rotation * expRotation(100.0 * kDegree * Eigen::Vector3d(0.3, 0.8, -0.5).normalized());
    guess.translation += Eigen::Vector3d(0.3, -0.2, 0.4);
    expectFound(kind, 2, guess);
  }
}

TEST(StartLaser, TellsOfARivalWhereBoardsAllFaceTheSameWay) {
  // Whatever is turned about the common normal fits as well, and the plates are large enough to hide it.
  for (const LaserKind kind : {LaserKind::scan, LaserKind::cloud}) {
    BundleScene scene = sceneOf(kind, 3);
    std::vector<LaserSight> sights;
    for (const double distance : {0.8, 1.0, 1.2, 1.4, 1.6, 1.8}) {
      const Pose T_reference_board{Eigen::Quaterniond::Identity(), {0.0, 0.0, distance}};
      ReturnSet returns;
      for (const Eigen::Vector3d& ray : raysOf(kind)) {
        if (const auto range =
                rangeOfPlate(ray, scene.truth.T_reference_laser.inverse() * T_reference_board, scene.board))
          returns.emplace_back(*range * ray);
      }
      sights.push_back({T_reference_board, {planeMoments(returns, kind, 0.008).value()}});
    }
    const auto start = startLaser(sights, kind, laserBesideCamera(), {4.0, 4.0});
    ASSERT_TRUE(start);
    ASSERT_TRUE(start->rival);
    EXPECT_GT(start->rival->rotation.angularDistance(start->T_reference_laser.rotation), 5.0 * kDegree);
  }
}

TEST(StartLaser, IsNoneWithoutCandidates) {
  const std::vector<LaserSight> sights(5, LaserSight{Pose{}, {}});
  EXPECT_FALSE(startLaser(sights, LaserKind::cloud, {}, kPlate));
  EXPECT_FALSE(startLaser({}, LaserKind::cloud, {}, kPlate));
}

TEST(StartLaser, LeavesACaptureWithoutItsBoardUnexplained) {
  BundleScene scene = sceneOf(LaserKind::cloud, 4);
  std::vector<LaserSight> sights = sightsOf(scene);
  sights[3].T_reference_board.translation += Eigen::Vector3d(0.1, 0.0, 0.3);
  sights[7].candidates.clear();
  const auto start = startLaser(sights, LaserKind::cloud, {}, kPlate);
  ASSERT_TRUE(start);
  EXPECT_FALSE(start->chosen[3]);
  EXPECT_FALSE(start->chosen[7]);
  EXPECT_LT(start->T_reference_laser.rotation.angularDistance(scene.truth.T_reference_laser.rotation),
            1.5 * kDegree);
}

TEST(WithRollOf, PointsAsThePoseAndTurnsTheGuessNoMoreThanThat) {
  Chance chance(5);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  for (int i = 0; i < 50; ++i) {
    const Pose guess = chance.pose(1.0, 1.0), pose = chance.pose(1.0, 1.0);
    const Pose rolled = withRollOf(guess, pose);
    EXPECT_THAT(rolled.rotation * x, IsNear(pose.rotation * x, 1e-12));
    EXPECT_EQ(rolled.translation, pose.translation);
    const double least = std::acos((guess.rotation * x).dot(pose.rotation * x));
    EXPECT_NEAR(rolled.rotation.angularDistance(guess.rotation), least, 1e-7);
  }
}

}  // namespace
}  // namespace thermovox::test
