#include "mapping/hot_clusters.hpp"

#include <gmock/gmock.h>

#include "tests/support/hot_surface.hpp"

namespace thermovox {
namespace {

using test::mapOf;
using test::PlanePatch;
using test::plateWith;
using test::returnsOf;
using testing::IsEmpty;
using testing::SizeIs;

constexpr HotspotCriteria kDelta10{};
constexpr HotspotCriteria kAbove40{.above = 40.0, .delta = std::nullopt};
const Eigen::Vector3d kMiddle(0.75, 0.75, 1.02);

std::uint32_t nearest(const SurfaceLayer& layer, const Eigen::Vector3d& p) {
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < layer.samples().size(); ++i) {
    if ((layer[i].p_world - p).norm() < (layer[best].p_world - p).norm()) best = i;
  }
  return best;
}

/// A wall of one temperature that stands on a floor of another.
ThermalMap wallAndFloor(double wall, double floor) {
  std::vector<MappedReturn> returns =
      returnsOf({.origin = {0, 0, 0.02}}, [=](const Eigen::Vector3d&) { return floor; });
  const PlanePatch standing{
      .origin = {1.52, 0, 0}, .along = Eigen::Vector3d::UnitY(), .across = Eigen::Vector3d::UnitZ()};
  for (const MappedReturn& one : returnsOf(standing, [=](const Eigen::Vector3d&) { return wall; })) {
    returns.push_back(one);
  }
  return mapOf(returns);
}

TEST(LocalReference, IsTheMedianOfTheSurroundingsWithItsSigma) {
  const ThermalMap map = plateWith({{kMiddle, 40.0, 0.05}}, {.celsius = 0.3});
  const SurfaceLayer layer(map);
  const std::uint32_t hottest = nearest(layer, kMiddle);
  const auto reference = localReference(layer, {hottest}, 0.2, std::vector<bool>(layer.samples().size()));
  ASSERT_TRUE(reference);
  EXPECT_NEAR(reference->celsius, 20.0, 0.05);
  // Cells of about six returns of 0.3 C, some 350 of them around.
  EXPECT_NEAR(reference->sigma, 1.25 * 0.3 / std::sqrt(6.0 * 350.0), 0.006);
}

TEST(LocalReference, LeavesOutOtherSpots) {
  const ThermalMap map = plateWith({{kMiddle, 40.0, 0.3}});
  const SurfaceLayer layer(map);
  const std::uint32_t hottest = nearest(layer, kMiddle);
  std::vector<bool> excluded(layer.samples().size());
  const auto all = localReference(layer, {hottest}, 0.2, excluded);
  for (std::uint32_t i = 0; i < excluded.size(); ++i) excluded[i] = layer[i].celsius > 30.0F;
  const auto without = localReference(layer, {hottest}, 0.2, excluded);
  ASSERT_TRUE(all && without);
  EXPECT_LT(without->celsius, all->celsius - 5.0);
}

TEST(LocalReference, OfALoneWireIsNone) {
  const ThermalMap map =
      mapOf(returnsOf({.length = 0.3, .width = 0.02}, [](const Eigen::Vector3d&) { return 50.0; }));
  const SurfaceLayer layer(map);
  EXPECT_FALSE(localReference(layer, {0}, 0.15, std::vector<bool>(layer.samples().size())));
}

TEST(LocalReference, WithoutNormalsComparesWithTheWarmerOfTheSurroundings) {
  // Scan lines 20 cm apart: no cell has a normal. Half of what is around is at 20 C, half at 30 C.
  const PlanePatch lines{.line_step = 0.2};
  const ThermalMap map =
      mapOf(returnsOf(lines, [](const Eigen::Vector3d& p) { return p.x() < 0.75 ? 20.0 : 30.0; }));
  const SurfaceLayer layer(map);
  const auto reference =
      localReference(layer, {nearest(layer, kMiddle)}, 0.1, std::vector<bool>(layer.samples().size()));
  ASSERT_TRUE(reference);
  EXPECT_NEAR(reference->celsius, 30.0, 0.3);
}

TEST(HotClusters, TwoPeaksFortyCentimetresApartAreTwo) {
  const ThermalMap map = plateWith({{{0.55, 0.75, 1.02}, 30.0, 0.06}, {{0.95, 0.75, 1.02}, 25.0, 0.06}});
  const SurfaceLayer layer(map);
  const auto clusters = hotClusters(layer, kDelta10);
  ASSERT_THAT(clusters, SizeIs(2));
  for (const HotCluster& cluster : clusters) {
    EXPECT_GE(cluster.size(), 5U);
    EXPECT_TRUE(std::is_sorted(cluster.begin(), cluster.end()));
  }
  EXPECT_LT(clusters[0].front(), clusters[1].front());
}

TEST(HotClusters, PeaksThatTouchArePartedAtTheSaddle) {
  // All cells between are hot. 0.3 m apart with widths of 8 cm the saddle has 0.34 of the peaks' rise.
  const auto apart = [](double distance) {
    return std::vector<test::HotPeak>{{kMiddle - Eigen::Vector3d(0.5 * distance, 0, 0), 60.0, 0.08},
                                      {kMiddle + Eigen::Vector3d(0.5 * distance, 0, 0), 60.0, 0.08}};
  };
  EXPECT_THAT(hotClusters(SurfaceLayer(plateWith(apart(0.3))), kDelta10), SizeIs(2));
  EXPECT_THAT(hotClusters(SurfaceLayer(plateWith(apart(0.15))), kDelta10), SizeIs(1));  // one hill
}

TEST(HotClusters, NoiseOnAPeakDoesNotPartIt) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ThermalMap map = plateWith({{kMiddle, 30.0, 0.15}}, {.seed = seed, .celsius = 1.0});
    EXPECT_THAT(hotClusters(SurfaceLayer(map), kDelta10), SizeIs(1)) << "seed " << seed;
  }
}

TEST(HotClusters, AHotWallBesideAColdFloorIsNoneByDelta) {
  const ThermalMap map = wallAndFloor(60.0, 20.0);
  EXPECT_THAT(hotClusters(SurfaceLayer(map), kDelta10), IsEmpty());
  EXPECT_THAT(hotClusters(SurfaceLayer(map), kAbove40), SizeIs(1));
}

TEST(HotClusters, ASeasonMakesNone) {
  EXPECT_THAT(hotClusters(SurfaceLayer(plateWith({}, {}, {}, 35.0)), kDelta10), IsEmpty());
  const std::vector<test::HotPeak> peak{{kMiddle, 20.0, 0.06}};
  const auto winter = hotClusters(SurfaceLayer(plateWith(peak, {}, {}, 5.0)), kDelta10);
  const auto summer = hotClusters(SurfaceLayer(plateWith(peak, {}, {}, 20.0)), kDelta10);
  EXPECT_EQ(winter, summer);
  EXPECT_THAT(winter, SizeIs(1));
}

TEST(HotClusters, EitherCriterionIsEnough) {
  const ThermalMap map = plateWith({{kMiddle, 15.0, 0.06}});
  const SurfaceLayer layer(map);
  EXPECT_THAT(hotClusters(layer, kAbove40), IsEmpty());
  EXPECT_THAT(hotClusters(layer, kDelta10), SizeIs(1));
  EXPECT_THAT(hotClusters(layer, {.above = 40.0, .delta = 10.0}), SizeIs(1));
  EXPECT_THAT(hotClusters(layer, {.above = 30.0, .delta = 30.0}), SizeIs(1));
}

TEST(HotClusters, OfNoTemperaturesAreNone) {
  EXPECT_THAT(hotClusters(SurfaceLayer(ThermalMap({})), kDelta10), IsEmpty());
  const ThermalMap geometry = mapOf(returnsOf({}, [](const Eigen::Vector3d&) { return std::nan(""); }));
  EXPECT_THAT(hotClusters(SurfaceLayer(geometry), kAbove40), IsEmpty());
}

}  // namespace
}  // namespace thermovox
