// How near the mapped points come to the truth of simulated missions: those of an independent program, where
// they are there, and our own with other seeds and another lens. The yardstick is a colouring that knows the
// true scene: perfect visibility from the frame nearest in time.
#include "tests/apps/accuracy.hpp"

#include <gtest/gtest.h>

namespace thermovox::test {
namespace {

TEST(Accuracy, CloudOfTheIndependentHall) {
  THERMOVOX_NEEDS_RECORDINGS();
  const Accuracy accuracy = recordedAccuracy("hall-cloud");
  EXPECT_LE(accuracy.coloured.mae(), 0.069);
  EXPECT_LE(accuracy.coloured.rms(), 0.30);
  EXPECT_GE(accuracy.kept, 0.97);
  EXPECT_GE(accuracy.sureShare(), 0.88);
  EXPECT_LE(accuracy.sure.mae(), 0.04);
  EXPECT_LE(accuracy.sure.rms(), 0.16);
  EXPECT_LE(accuracy.position_rms, 0.009);
  expectHonestSigmas(accuracy);
}

TEST(Accuracy, ScanOfTheIndependentHall) {
  THERMOVOX_NEEDS_RECORDINGS();
  const Accuracy accuracy = recordedAccuracy("hall-scan");
  EXPECT_LE(accuracy.coloured.mae(), 0.12);
  EXPECT_LE(accuracy.coloured.rms(), 0.6);
  EXPECT_GE(accuracy.kept, 0.95);
  EXPECT_LE(accuracy.position_rms, 0.009);
  expectHonestSigmas(accuracy);
}

// A beam alone cannot know what hides its points: its figures are written down, not bounded.
TEST(Accuracy, BeamOfTheIndependentHall) {
  THERMOVOX_NEEDS_RECORDINGS();
  const Accuracy accuracy = recordedAccuracy("hall-beam");
  EXPECT_GE(accuracy.kept, 0.95);
  EXPECT_LE(accuracy.position_rms, 0.009);
}

/// Our halls are more cluttered and each is different, so that a colouring is measured by the perfect one.
void expectNearlyPerfect(const Accuracy& accuracy) {
  EXPECT_LE(accuracy.coloured.mae(), 1.25 * accuracy.perfect.mae() + 0.01);
  EXPECT_GE(accuracy.kept, 0.95);
  EXPECT_LE(accuracy.position_rms, 0.009);  // the noise of a range is 10 mm along the ray
  expectHonestSigmas(accuracy);
}

TEST(Accuracy, CloudsOfOtherHalls) {
  expectNearlyPerfect(flownAccuracy("cloud 21", LaserKind::cloud, 21, LensModel::brown_conrady));
  expectNearlyPerfect(flownAccuracy("cloud 22", LaserKind::cloud, 22, LensModel::brown_conrady));
}

TEST(Accuracy, CloudThroughAWideLens) {
  expectNearlyPerfect(flownAccuracy("cloud 23 wide", LaserKind::cloud, 23, LensModel::kannala_brandt));
}

TEST(Accuracy, ScansOfOtherHalls) {
  expectNearlyPerfect(flownAccuracy("scan 21", LaserKind::scan, 21, LensModel::brown_conrady));
  expectNearlyPerfect(flownAccuracy("scan 22", LaserKind::scan, 22, LensModel::brown_conrady));
}

TEST(Accuracy, ScanThroughAWideLens) {
  expectNearlyPerfect(flownAccuracy("scan 23 wide", LaserKind::scan, 23, LensModel::kannala_brandt));
}

TEST(Accuracy, BeamOfAnotherHall) {
  const Accuracy accuracy = flownAccuracy("beam 21", LaserKind::beam, 21, LensModel::brown_conrady);
  EXPECT_GE(accuracy.kept, 0.95);
  EXPECT_LE(accuracy.position_rms, 0.009);
}

}  // namespace
}  // namespace thermovox::test
