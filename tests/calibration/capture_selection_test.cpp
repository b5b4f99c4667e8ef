#include "calibration/capture_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {
namespace {

constexpr std::array<LaserKind, 3> kKinds{LaserKind::beam, LaserKind::scan, LaserKind::cloud};
constexpr double kTurnSigma = 0.1 * kDegree, kShiftSigma = 0.001;  // of boards by their images

struct Moved {
  std::vector<CaptureSight> sights;
  std::vector<bool> sound;
};

/// Captures of which some have been moved, by 5 to 8 cm towards or away from the laser and 3 to 8 degrees.
Moved capturesOf(LaserKind kind, std::size_t captures, std::size_t spoiled, std::uint64_t seed) {
  BundleScene scene = made(
      {.kind = kind, .captures = captures, .range_sigma = 0.008, .range_bias_sigma = 0.005, .seed = seed});
  Chance chance(seed + 1000);
  Moved moved_some;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(kTurnSigma * kTurnSigma),
      Eigen::Vector3d::Constant(kShiftSigma * kShiftSigma);
  for (std::size_t i = 0; i < captures; ++i) {
    Pose seen = moved(scene.truth.T_reference_board[i], chance, kTurnSigma, kShiftSigma);
    const bool sound = i >= spoiled;
    if (!sound) {
      const double away = chance.uniform(0.05, 0.08) * (chance.uniform(-1.0, 1.0) > 0.0 ? 1.0 : -1.0);
      const Eigen::Vector3d turn = chance.uniform(3.0, 8.0) * kDegree * chance.normal3().normalized();
      seen = {(expRotation(turn) * seen.rotation).normalized(),
              seen.translation + away * Eigen::Vector3d::UnitZ()};
    }
    moved_some.sights.push_back({seen, covariance, scene.data.captures[i].plane});
    moved_some.sound.push_back(sound);
  }
  return moved_some;
}

Pose startNear(std::uint64_t seed) {
  Chance chance(seed);
  return moved(laserBesideCamera(), chance, 1.0 * kDegree, 0.01);
}

struct Found {
  std::size_t planted = 0, found = 0, sound_dropped = 0;
};

Found foundOver20Seeds(LaserKind kind, std::size_t captures, std::size_t spoiled) {
  Found sum;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Moved some = capturesOf(kind, captures, spoiled, seed);
    const CaptureSelection selection = selectCaptures(some.sights, kind, startNear(seed));
    for (std::size_t i = 0; i < captures; ++i) {
      sum.planted += some.sound[i] ? 0 : 1;
      sum.found += !some.sound[i] && !selection.counts[i] ? 1 : 0;
      sum.sound_dropped += some.sound[i] && !selection.counts[i] ? 1 : 0;
    }
  }
  return sum;
}

TEST(SelectCaptures, FindsWhatWasMovedAndDropsNothingSound) {
  // By chance 2.5e-4 of 400 are dropped, of a beam's 760: 0.1 and 0.2 in all twenty runs.
  const Found beam = foundOver20Seeds(LaserKind::beam, 40, 2);
  // A beam has one number a capture: a move of four sigmas of it is not told from chance.
  EXPECT_GE(beam.found + 4, beam.planted);
  EXPECT_LE(beam.sound_dropped, 1U);
  const Found scan = foundOver20Seeds(LaserKind::scan, 24, 3),
              cloud = foundOver20Seeds(LaserKind::cloud, 24, 4);
  EXPECT_EQ(scan.found, scan.planted);
  EXPECT_EQ(scan.sound_dropped, 0U);
  EXPECT_EQ(cloud.found, cloud.planted);
  EXPECT_EQ(cloud.sound_dropped, 0U);
}

/// Those that moved hide each other from a fit to all: the sigma of the biases would be 15 to 25 mm with
/// them.
TEST(SelectCaptures, FindsASixthThatWasMoved) {
  const Found beam = foundOver20Seeds(LaserKind::beam, 40, 6),
              scan = foundOver20Seeds(LaserKind::scan, 24, 4);
  EXPECT_GE(static_cast<double>(beam.found), 0.8 * static_cast<double>(beam.planted));
  EXPECT_GE(static_cast<double>(scan.found), 0.9 * static_cast<double>(scan.planted));
}

TEST(SelectCaptures, KeepsEverythingWhereNothingWasMoved) {
  for (const LaserKind kind : kKinds) {
    std::size_t dropped = 0;
    for (std::uint64_t seed = 51; seed <= 60; ++seed) {
      const Moved captures = capturesOf(kind, 14, 0, seed);
      const CaptureSelection selection = selectCaptures(captures.sights, kind, startNear(seed));
      dropped +=
          static_cast<std::size_t>(std::count(selection.counts.begin(), selection.counts.end(), false));
    }
    EXPECT_EQ(dropped, 0U) << dimensionsOf(kind) << "D";
  }
}

TEST(SelectCaptures, JudgesNoFewerThanSix) {
  Moved captures = capturesOf(LaserKind::cloud, 5, 1, 3);
  const CaptureSelection selection = selectCaptures(captures.sights, LaserKind::cloud, startNear(3));
  EXPECT_EQ(std::count(selection.counts.begin(), selection.counts.end(), true), 5);
}

TEST(SelectCaptures, FindsTheLaserByWhatCounts) {
  const Moved captures = capturesOf(LaserKind::cloud, 20, 4, 4);
  const CaptureSelection selection = selectCaptures(captures.sights, LaserKind::cloud, startNear(4));
  const Pose& truth = laserBesideCamera();
  // 16 planes with 5 mm of bias and 1.7 mrad of tilt each: about 0.05 degrees and 2 mm, here four times that.
  EXPECT_LT(selection.T_reference_laser.rotation.angularDistance(truth.rotation), 0.2 * kDegree);
  EXPECT_LT((selection.T_reference_laser.translation - truth.translation).norm(), 0.01);
  // 5 mm of 16 captures: within a factor of two.
  EXPECT_NEAR(std::log(selection.range_bias_sigma / 0.005), 0.0, std::log(2.0));
}

TEST(SelectCaptures, SaysNothingOfCapturesWithoutAPlane) {
  Moved captures = capturesOf(LaserKind::cloud, 12, 0, 5);
  captures.sights[2].plane.reset();
  captures.sights[9].plane.reset();
  const CaptureSelection selection = selectCaptures(captures.sights, LaserKind::cloud, startNear(5));
  EXPECT_FALSE(selection.counts[2]);
  EXPECT_FALSE(selection.counts[9]);
  EXPECT_EQ(selection.probability[2], 1.0);
  EXPECT_EQ(std::count(selection.counts.begin(), selection.counts.end(), true), 10);
}

TEST(SelectCaptures, HasProbabilitiesThatAreEven) {
  // Of sound captures a tenth is below 0.1, half below 0.5: 600 of them, four standard errors.
  std::size_t all = 0, tenth = 0, half = 0;
  for (std::uint64_t seed = 101; seed <= 120; ++seed) {
    const Moved captures = capturesOf(LaserKind::cloud, 30, 0, seed);
    const CaptureSelection selection = selectCaptures(captures.sights, LaserKind::cloud, startNear(seed));
    for (const double probability : selection.probability) {
      ++all;
      tenth += probability < 0.1 ? 1 : 0;
      half += probability < 0.5 ? 1 : 0;
    }
  }
  const auto n = static_cast<double>(all);
  EXPECT_NEAR(static_cast<double>(tenth) / n, 0.1, 4.0 * std::sqrt(0.09 / n) + 0.02);
  EXPECT_NEAR(static_cast<double>(half) / n, 0.5, 4.0 * std::sqrt(0.25 / n) + 0.03);
}

}  // namespace
}  // namespace thermovox::test
