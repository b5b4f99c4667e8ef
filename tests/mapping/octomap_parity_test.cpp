// The oracle for occupancy: OctoMap's insertPointCloud on the same returns.

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <random>

#include "tests/support/octomap_oracle.hpp"
#include "tests/support/recorded_scan.hpp"

namespace thermovox {
namespace {

using test::OctomapOracle;

TEST(OctomapParity, OnARecordedScanAtSeveralResolutions) {
  THERMOVOX_NEEDS_RECORDINGS();
  const std::vector<MappedReturn> reading = test::recordedScan();
  ASSERT_EQ(reading.size(), 88206U);
  for (const double resolution : {0.05, 0.1, 0.25}) {
    SCOPED_TRACE(resolution);
    OctomapOracle oracle({.resolution = resolution});
    oracle.integrate(reading);
    oracle.expectParity();
  }
}

TEST(OctomapParity, OnManyReadingsThatReachTheClamps) {
  std::mt19937 rng(31);
  std::uniform_real_distribution<double> coordinate(-2.0, 2.0), height(-1.0, 1.0);
  OctomapOracle oracle({.resolution = 0.1});
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d origin(0.3 * coordinate(rng), 0.3 * coordinate(rng), 0.2 * height(rng));
    std::vector<MappedReturn> reading;
    for (int j = 0; j < 200; ++j) {
      reading.push_back({{coordinate(rng), coordinate(rng), height(rng)}, origin, Time{}, {}});
    }
    oracle.integrate(reading);
  }
  oracle.expectParity();
}

TEST(OctomapParity, OnALaserThatFliesExactlyOnTheBordersOfCells) {
  std::mt19937 rng(32);
  std::uniform_real_distribution<double> coordinate(-8.0, 8.0);
  for (const double height : {0.0, 0.3, 0.7, 1.1, -0.6}) {
    OctomapOracle oracle({.resolution = 0.1});
    for (int i = 0; i < 10; ++i) {
      std::vector<MappedReturn> reading;
      for (int j = 0; j < 100; ++j) {
        reading.push_back({{coordinate(rng), coordinate(rng), height}, {0.1 * i, 0.2, height}, Time{}, {}});
      }
      oracle.integrate(reading);
    }
    SCOPED_TRACE(height);
    oracle.expectParity();
  }
}

// With hit and miss in another proportion the rounded steps may carry a sum over the threshold that OctoMap's
// own sum does not reach, or the other way round. Nothing else may differ: where both log-odds are on one
// side of the threshold, the state is the same.
TEST(OctomapParity, WithOtherSensorModels) {
  std::mt19937 rng(33);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0), hit(0.6, 0.9), miss(0.3, 0.45);
  constexpr int kReadings = 30;
  for (const double occupied : {0.5, 0.5, 0.5, 0.5, 0.5, 0.3, 0.6, 0.75, 0.9}) {
    OctomapOracle oracle({.resolution = 0.15, .occupancy = {hit(rng), miss(rng), 0.1, 0.97, occupied}});
    for (int i = 0; i < kReadings; ++i) {
      std::vector<MappedReturn> reading;
      for (int j = 0; j < 100; ++j) {
        reading.push_back({{coordinate(rng), coordinate(rng), coordinate(rng)}, {0.1, 0.2, 0.3}, Time{}, {}});
      }
      oracle.integrate(reading);
    }
    const OctomapOracle::Comparison result = oracle.compare();
    SCOPED_TRACE(occupied);
    EXPECT_EQ(result.only_ours, 0U);
    EXPECT_EQ(result.other_state_clearly, 0U);
    // Half a quantum since the last clamping, and what each miss of the readings since then is rounded by.
    const OccupancyModel& rounded = oracle.map().occupancyModel();
    EXPECT_LE(result.worst_log_odds, rounded.quantum() * (0.5 + kReadings * rounded.missError()) + 1e-5);
  }
}

}  // namespace
}  // namespace thermovox
