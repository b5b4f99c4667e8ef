#include "calibration/free_intrinsics.hpp"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {
namespace {

CameraGuess guessOf(LensModel model, int distortion_count) {
  CameraGuess guess;
  guess.intrinsics = lensOf(model);
  guess.intrinsics.distortion_count = distortion_count;
  return guess;
}

TEST(FreeIntrinsics, AreFocalLengthsAndMiddleOfEveryLens) {
  EXPECT_EQ(freeIntrinsics(guessOf(LensModel::pinhole, 0), 10), (std::vector<int>{kFx, kFy, kCx, kCy}));
}

TEST(FreeIntrinsics, HoldThirdAndHigherCoefficientsOfBrownAndConrady) {
  const std::vector<int> first_four{
      kFx, kFy, kCx, kCy, kDistortion, kDistortion + 1, kDistortion + 2, kDistortion + 3};
  for (const int count : {4, 5, 8})
    EXPECT_EQ(freeIntrinsics(guessOf(LensModel::brown_conrady, count), 10), first_four) << count;
  EXPECT_EQ(freeIntrinsics(guessOf(LensModel::brown_conrady, 0), 10).size(), 4U);
}

TEST(FreeIntrinsics, AreAllOfKannalaAndBrandt) {
  EXPECT_EQ(freeIntrinsics(guessOf(LensModel::kannala_brandt, 4), 10).size(), 8U);
}

TEST(FreeIntrinsics, AreNoneOfALensToKeepOrSeenTooSeldom) {
  CameraGuess guess = guessOf(LensModel::brown_conrady, 5);
  EXPECT_TRUE(freeIntrinsics(guess, 2).empty());
  EXPECT_FALSE(freeIntrinsics(guess, 3).empty());
  guess.lens = CameraGuess::Lens::keep;
  EXPECT_TRUE(freeIntrinsics(guess, 40).empty());
}

}  // namespace
}  // namespace thermovox::test
