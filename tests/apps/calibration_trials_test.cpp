// The calibration on a few of the trials that tests/benchmark makes by the hundred.
#include "tests/benchmark/calibration_trials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace thermovox::bench {
namespace {

constexpr std::size_t kRuns = 6;

TrialSet setNamed(const std::string& name) {
  const std::vector<TrialSet> sets = trialSets();
  return *std::find_if(sets.begin(), sets.end(), [&](const TrialSet& set) { return set.name == name; });
}

class CalibrationTrials : public testing::TestWithParam<std::string> {};

// Six trials have 30 to 36 squared errors in sigmas: their mean lies within 0.45 and 1.8 but once in some
// hundred times. The root mean square of an error of three parts over six trials lies within 1.5 of the bound
// (18 squares, mean 2.25) once in a thousand times where the estimator reaches it.
TEST_P(CalibrationTrials, ReachTheBoundAndKnowIt) {
  const CalibrationSummary summary = calibrationTrials(setNamed(GetParam()), 1, kRuns);
  EXPECT_EQ(summary.observable, kRuns);
  EXPECT_LE(summary.rotation_error, 1.5 * summary.rotation_bound);
  EXPECT_LE(summary.translation_error, 1.5 * summary.translation_bound);
  EXPECT_GE(summary.nees, 0.45);
  EXPECT_LE(summary.nees, 1.8);
  EXPECT_EQ(summary.sound_dropped, 0U);
}

INSTANTIATE_TEST_SUITE_P(Lasers, CalibrationTrials,
                         testing::Values("3D, both cameras, no bias", "2D, lines and edges", "1D, averaged"),
                         [](const auto& about) { return about.param.substr(0, 1) + "D"; });

// Both cameras know where the board is to a fraction of a millimetre: whatever moved by centimetres is seen.
TEST(SpoiledCaptures, AreAllNamed) {
  TrialSet set = setNamed("3D, both cameras, no bias");
  set.spoiled = 4;
  const CalibrationSummary summary = calibrationTrials(set, 1, 2);
  EXPECT_EQ(summary.spoiled_found, 8U);
  EXPECT_EQ(summary.sound_dropped, 0U);
}

}  // namespace
}  // namespace thermovox::bench
