// The error bars of hot spots on a few of the trials that tests/benchmark makes by the hundred.
#include "tests/benchmark/hotspot_trials.hpp"

#include <gtest/gtest.h>

namespace thermovox::bench {
namespace {

constexpr std::size_t kRuns = 30;

// Two joints of one run share its errors, so that 30 runs are worth 30 draws or little more. Of 30 draws,
// with 95 % within, fewer than 25 are within once in a thousand times. The mean of 30 chi squared with three
// degrees of freedom, each divided by three, lies outside 0.55 to 1.6 once in two hundred times; bars that
// are twice too wide or too narrow make it 0.25 or 4.
TEST(HotspotTrials, WithAllErrorsDrawnTheBarsHoldTheTruth) {
  const TrialSummary summary = summaryOf(hotspotTrials(errorSets().back(), 1, kRuns));
  EXPECT_GE(summary.found, summary.joints - 1);
  EXPECT_GE(summary.position_coverage, 25.0 / 30.0);
  EXPECT_GE(summary.position_nees, 0.55);
  EXPECT_LE(summary.position_nees, 1.6);
  EXPECT_GE(summary.peak_coverage, 25.0 / 30.0);
  EXPECT_GE(summary.peak_nees, 0.4);
  EXPECT_LE(summary.peak_nees, 1.8);
}

TEST(HotspotTrials, WithNoiseAloneJointsAreFoundWithinMillimetres) {
  const TrialSummary summary = summaryOf(hotspotTrials(errorSets().front(), 1, 10));
  EXPECT_EQ(summary.found, summary.joints);
  EXPECT_GE(summary.position_coverage, 0.85);
  EXPECT_LE(summary.mean_distance, 0.005);
  EXPECT_LE(summary.mean_peak_error, 0.6);
}

}  // namespace
}  // namespace thermovox::bench
