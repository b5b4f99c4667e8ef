#include "mapping/hotspot_detection.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "projection/error.hpp"
#include "tests/support/hot_surface.hpp"

namespace thermovox {
namespace {

using test::HotPeak;
using test::mapOf;
using test::PlanePatch;
using test::plateWith;
using test::returnsOf;
using test::SurfaceNoise;
using testing::IsEmpty;
using testing::SizeIs;

const Eigen::Vector3d kMiddle(0.76, 0.74, 1.02);
/// Blur of a camera so sharp that it leaves the peaks as they are.
const CameraSight kSharp{.focal_px = 5000.0, .blur_px = 0.1, .bias_sigma = 2.0};

std::vector<Hotspot> spotsOf(const ThermalMap& map, const HotspotCriteria& criteria = {},
                             const CameraSight& camera = kSharp) {
  return findHotspots(SurfaceLayer(map), criteria, camera);
}

TEST(FindHotspots, FindsAPeakWhereAndAsHotAsItIs) {
  const ThermalMap map = plateWith({{kMiddle, 40.0, 0.06}});
  const std::vector<Hotspot> spots = spotsOf(map);
  ASSERT_THAT(spots, SizeIs(1));
  const Hotspot& spot = spots[0];
  EXPECT_LT((spot.position.p_world - kMiddle).norm(), 0.004);
  // A cell of 5 cm is a mean of what it covers: of a width of 6 cm it takes a few percent off.
  EXPECT_NEAR(spot.peak.value, 60.0, 3.0);
  EXPECT_NEAR(spot.reference.value, 20.0, 0.3);
  EXPECT_NEAR(spot.delta.value, spot.peak.value - spot.reference.value, 1e-9);
  EXPECT_NEAR(spot.width, 0.06, 0.01);
  EXPECT_EQ(spot.bias_sigma, 2.0);
  EXPECT_GT(std::abs(spot.normal.z()), 0.99);
  EXPECT_FALSE(spot.readsLow());
  EXPECT_GE(spot.hottest_cell, spot.p95);
  EXPECT_GE(spot.p95, spot.mean);
  EXPECT_EQ(spot.best_view.range, 3.0F);
  EXPECT_LE(spot.first_seen, spot.last_seen);
  // Hotter than 10 C over the plate within 6 cm * sqrt(2 ln 4) = 10 cm.
  EXPECT_NEAR(spot.area, 0.0314, 0.012);
  EXPECT_NEAR(spot.extent.x(), 0.2, 0.06);
  EXPECT_NEAR(spot.extent.z(), 0.05, 1e-9);
}

TEST(FindHotspots, SaysHowSureItIsOfThePlace) {
  // The random part alone: noise of temperatures and ranges, new for each of 60 maps. The model's error
  // widens the bars: what a real peak differs from a Gaussian by.
  double nees = 0.0;
  constexpr unsigned kRuns = 60;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const auto spots =
        spotsOf(plateWith({{kMiddle, 30.0, 0.06}}, {.seed = seed, .celsius = 1.0, .range = 0.005}));
    ASSERT_THAT(spots, SizeIs(1));
    const Eigen::Vector3d off = spots[0].position.p_world - kMiddle;
    nees += off.dot(spots[0].position.random.inverse() * off) / 3.0 / kRuns;
    EXPECT_TRUE(spots[0].position.common.isZero());
  }
  EXPECT_LT(nees, 1.5);
  EXPECT_GT(nees, 0.2);
}

TEST(FindHotspots, TwoJointsFortyCentimetresApartAreTwoTheHottestFirst) {
  const Eigen::Vector3d left(0.55, 0.75, 1.02), right(0.95, 0.75, 1.02);
  const auto spots = spotsOf(plateWith({{left, 25.0, 0.06}, {right, 40.0, 0.06}}));
  ASSERT_THAT(spots, SizeIs(2));
  EXPECT_LT((spots[0].position.p_world - right).norm(), 0.006);
  EXPECT_LT((spots[1].position.p_world - left).norm(), 0.006);
  EXPECT_GT(spots[0].peak.value, spots[1].peak.value);
}

TEST(FindHotspots, PiecesOfOneJointOnScanLinesAreOneSpot) {
  // Lines 14 cm apart over a joint of 12 cm: no cell of one line has a neighbour on the next.
  PlanePatch lines{.line_step = 0.14};
  const auto spots = spotsOf(plateWith({{kMiddle, 50.0, 0.12}}, {}, lines));
  ASSERT_THAT(spots, SizeIs(1));
  EXPECT_LT((spots[0].position.p_world - kMiddle).norm(), 0.02);
  EXPECT_NEAR(spots[0].peak.value, 70.0, 5.0);
  EXPECT_GT(spots[0].extent.y(), 0.25);  // more than one line
}

TEST(FindHotspots, OnAPipeLieOnThePipe) {
  constexpr double kRadius = 0.3;
  const Eigen::Vector3d spot(0.0, kRadius, 0.5);
  std::vector<MappedReturn> returns;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (int a = 0; a < 240; ++a) {
    const double angle = a * M_PI / 120.0;
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
      const Eigen::Vector3d p = (kRadius + 0.002 * normal(random)) * out + Eigen::Vector3d(0, 0, 0.01 * k);
      const double c = 30.0 + test::riseAt({{spot, 40.0, 0.06}}, p) + 0.1 * normal(random);
      returns.push_back(
          {p, 5.0 * out, Time{}, TemperatureObservation{static_cast<float>(c), 0.1F, 2.0F, 0.0F}});
    }
  }
  const auto spots = spotsOf(mapOf(returns));
  ASSERT_THAT(spots, SizeIs(1));
  EXPECT_LT((spots[0].position.p_world - spot).norm(), 0.006);
  EXPECT_GT(std::abs(spots[0].normal.y()), 0.98);
}

TEST(FindHotspots, AHotWallBesideAColdFloorIsNone) {
  std::vector<MappedReturn> returns =
      returnsOf({.origin = {0, 0, 0.02}}, [](const Eigen::Vector3d&) { return 20.0; });
  const PlanePatch wall{
      .origin = {1.52, 0, 0}, .along = Eigen::Vector3d::UnitY(), .across = Eigen::Vector3d::UnitZ()};
  for (const MappedReturn& one : returnsOf(wall, [](const Eigen::Vector3d&) { return 60.0; }))
    returns.push_back(one);
  EXPECT_THAT(spotsOf(mapOf(returns)), IsEmpty());
}

TEST(FindHotspots, AWarmWallBehindSomethingColdIsNone) {
  // So little of the wall is left to see that nothing of it can be compared with: its surroundings are cold.
  std::vector<MappedReturn> returns =
      returnsOf({.origin = {0, 0, 0.72}}, [](const Eigen::Vector3d&) { return 20.0; });
  const PlanePatch seen{.origin = {0.4, 0.7, 1.02}, .length = 0.17, .width = 0.17};
  for (const MappedReturn& one : returnsOf(seen, [](const Eigen::Vector3d&) { return 40.0; }))
    returns.push_back(one);
  EXPECT_THAT(spotsOf(mapOf(returns), {.delta = 10.0}), IsEmpty());
  EXPECT_THAT(spotsOf(mapOf(returns), {.above = 35.0, .delta = {}}), SizeIs(testing::Ge(1)));
}

TEST(FindHotspots, ASeasonOf15DegreesChangesNoDelta) {
  const std::vector<HotPeak> peaks{{{0.5, 0.5, 1.02}, 30.0, 0.06}, {{1.0, 1.0, 1.02}, 20.0, 0.08}};
  const auto winter = spotsOf(plateWith(peaks, {}, {}, 5.0)),
             summer = spotsOf(plateWith(peaks, {}, {}, 20.0));
  ASSERT_EQ(winter.size(), 2U);
  ASSERT_EQ(summer.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    // Not more than temperatures in steps of 2 mK, and single precision, allow.
    EXPECT_NEAR(summer[i].delta.value, winter[i].delta.value, 0.02);
    EXPECT_NEAR(summer[i].peak.value, winter[i].peak.value + 15.0, 0.02);
  }
}

TEST(FindHotspots, PutsBackWhatBlurTakesOffAndSaysWhereItCannot) {
  // A camera of 152 px at 3 m: 0.7 px and interpolation are a Gaussian of b = 16 mm.
  const CameraSight camera{.focal_px = 152.0, .blur_px = 0.7};
  const double b2 = std::pow(3.0 / 152.0, 2) * (0.49 + 1.0 / 6.0);
  for (const double width : {0.05, 0.08}) {
    const double seen2 = width * width + b2;  // as the camera shows a peak of 40 C
    const auto spots =
        spotsOf(plateWith({{kMiddle, 40.0 * width * width / seen2, std::sqrt(seen2)}}), {}, camera);
    ASSERT_THAT(spots, SizeIs(1));
    EXPECT_NEAR(spots[0].peak.value, 60.0, 3.5) << width;
    EXPECT_GT(spots[0].peak.value, spots[0].hottest_cell);
    EXPECT_FALSE(spots[0].readsLow());
  }
  // From so far away that a pixel is as wide as the joint it reads low.
  const CameraSight coarse{.focal_px = 40.0, .blur_px = 0.7};
  const auto spots = spotsOf(plateWith({{kMiddle, 40.0, 0.06}}), {}, coarse);
  ASSERT_THAT(spots, SizeIs(1));
  EXPECT_TRUE(spots[0].readsLow());
}

TEST(FindHotspots, CountsPixelsOfTheBestView) {
  const CameraSight camera{.focal_px = 152.0};
  const auto spots = spotsOf(plateWith({{kMiddle, 40.0, 0.06}}), {}, camera);
  ASSERT_THAT(spots, SizeIs(1));
  EXPECT_NEAR(spots[0].pixels, spots[0].area * 152.0 * 152.0 / 9.0, 1e-6);
}

TEST(FindHotspots, WhatDoesNotStandOutOfItsNoiseIsNone) {
  SurfaceNoise noise{.celsius = 8.0};
  for (noise.seed = 1; noise.seed <= 10; ++noise.seed) {
    EXPECT_THAT(spotsOf(plateWith({}, noise, {.step = 0.06, .line_step = 0.06})), IsEmpty());
  }
}

TEST(FindHotspots, HolesInTheTemperaturesDoNotMoveASpot) {
  const auto seen = [](const Eigen::Vector3d& p) {
    if (p.x() > kMiddle.x() + 0.02) return std::nan("");  // nobody saw the right of it
    return 20.0 + test::riseAt({{kMiddle, 40.0, 0.08}}, p);
  };
  const auto spots = spotsOf(mapOf(returnsOf({}, seen)));
  ASSERT_THAT(spots, SizeIs(1));
  EXPECT_LT((spots[0].position.p_world - kMiddle).norm(), 0.015);
}

TEST(FindHotspots, OfNothingAreNone) {
  EXPECT_THAT(spotsOf(ThermalMap({})), IsEmpty());
  EXPECT_THAT(spotsOf(mapOf(returnsOf({}, [](const Eigen::Vector3d&) { return std::nan(""); }))), IsEmpty());
  EXPECT_THAT(spotsOf(plateWith({})), IsEmpty());
}

TEST(FindHotspots, AreTheSameEveryTimeAndInAnyOrderOfTheParts) {
  const ThermalMap a = plateWith({{{0.5, 0.5, 1.02}, 30.0, 0.06}, {{1.0, 1.0, 1.02}, 30.0, 0.06}});
  const ThermalMap b = plateWith({{{3.0, 0.5, 1.02}, 30.0, 0.06}}, {.seed = 2}, {.origin = {2.0, 0.0, 1.02}});
  ThermalMap ab(a.options()), ba(a.options());
  ab.merge(a);
  ab.merge(b);
  ba.merge(b);
  ba.merge(a);
  const auto one = spotsOf(ab), other = spotsOf(ba), again = spotsOf(ab);
  ASSERT_THAT(one, SizeIs(3));
  ASSERT_THAT(other, SizeIs(3));
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].position.p_world, other[i].position.p_world);
    EXPECT_EQ(one[i].peak.value, other[i].peak.value);
    EXPECT_EQ(one[i].cells, other[i].cells);
    EXPECT_EQ(one[i].position.random, again[i].position.random);
  }
}

TEST(HotspotCriteria, NamesWhatCannotBe) {
  for (const HotspotCriteria& bad :
       {HotspotCriteria{.delta = std::nullopt}, HotspotCriteria{.delta = 0.0}, HotspotCriteria{.delta = -3.0},
        HotspotCriteria{.delta = std::nan("")}, HotspotCriteria{.above = std::nan("")},
        HotspotCriteria{.above = std::numeric_limits<double>::infinity()}}) {
    EXPECT_THROW(bad.validate(), ConfigError);
    EXPECT_THROW((void)spotsOf(ThermalMap({}), bad), ConfigError);
  }
  HotspotCriteria{.above = -40.0, .delta = std::nullopt}.validate();
}

}  // namespace
}  // namespace thermovox
