#include "mapping/surface_layer.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "tests/support/hot_surface.hpp"

namespace thermovox {
namespace {

using test::mapOf;
using test::PlanePatch;
using test::plateWith;
using test::returnsOf;

double uniform20(const Eigen::Vector3d&) {
  return 20.0;
}

TEST(SurfaceLayer, HasTheCellsWithATemperatureInTheMapsOrder) {
  const ThermalMap map = mapOf(
      returnsOf({}, [](const Eigen::Vector3d& p) { return p.x() < 0.7 ? 20.0 + p.y() : std::nan(""); }));
  const SurfaceLayer layer(map);
  EXPECT_EQ(layer.resolution(), 0.05);
  std::vector<CellKey> keys;
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    if (cell.observations > 0) keys.push_back(key);
  });
  ASSERT_EQ(layer.samples().size(), keys.size());
  ASSERT_LT(keys.size(), map.surfaceCount());  // some have none
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    const SurfaceCell& cell = *map.surface(keys[i]);
    ASSERT_EQ(layer[i].key, keys[i]);
    EXPECT_EQ(layer[i].celsius, static_cast<float>(cell.mean()));
    EXPECT_EQ(layer[i].sigma, static_cast<float>(cell.sigmaOfMean()));
    EXPECT_EQ(layer[i].observations, static_cast<std::uint32_t>(cell.observations));
    EXPECT_EQ(map.keyOf(layer[i].p_world), keys[i]);
    EXPECT_EQ(layer[i].last, cell.last());
  }
}

TEST(SurfaceLayer, WithoutTemperaturesIsEmptyAndAnswers) {
  const ThermalMap empty({});
  EXPECT_TRUE(SurfaceLayer(empty).samples().empty());
  EXPECT_THAT(SurfaceLayer(empty).within({0, 0, 0}, 100.0), testing::IsEmpty());
  const ThermalMap geometry = mapOf(returnsOf({}, [](const Eigen::Vector3d&) { return std::nan(""); }));
  EXPECT_TRUE(SurfaceLayer(geometry).samples().empty());
}

TEST(SurfaceLayer, FindsWhatLiesWithinARadius) {
  // Far from the origin, where a float would be coarser than the cells.
  const ThermalMap map = mapOf(returnsOf({.origin = {120'003.0, -45'678.0, 12.02}, .step = 0.05}, uniform20));
  const SurfaceLayer layer(map);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.2, 1.7), length(0.01, 0.8);
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector3d p =
        Eigen::Vector3d(120'003.0, -45'678.0, 12.0) + Eigen::Vector3d(place(random), place(random), 0.1);
    const double radius = length(random);
    const std::vector<std::uint32_t> found = layer.within(p, radius);
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (std::uint32_t i = 0; i < layer.samples().size(); ++i) {
      const double distance = (layer[i].p_world - p).norm();
      if (std::abs(distance - radius) < 1e-5) continue;  // floats
      ASSERT_EQ(std::binary_search(found.begin(), found.end(), i), distance < radius) << distance;
    }
  }
}

TEST(SurfaceLayer, KnowsTheNormalOfAPlane) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 0.5).normalized()));
  const PlanePatch patch{.along = turn * Eigen::Vector3d::UnitX(), .across = turn * Eigen::Vector3d::UnitY()};
  const ThermalMap map = mapOf(returnsOf(patch, uniform20));
  const SurfaceLayer layer(map);
  std::size_t inside = 0;
  for (std::uint32_t i = 0; i < layer.samples().size(); ++i) {
    const Eigen::Vector3d d = layer[i].p_world - patch.at(0.75, 0.75);
    if (d.norm() > 0.6) continue;  // at the border few neighbours are left
    ++inside;
    EXPECT_GT(std::abs(layer.normal(i).cast<double>().dot(patch.normal())), std::cos(0.1));
  }
  EXPECT_GT(inside, 300U);
}

TEST(SurfaceLayer, KnowsTheNormalsOfAPipe) {
  constexpr double kRadius = 0.5;
  std::vector<MappedReturn> returns;
  for (int a = 0; a < 180; ++a) {
    const double angle = a * std::numbers::pi / 90.0;
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector3d p(kRadius * std::cos(angle), kRadius * std::sin(angle), 0.02 * k);
      returns.push_back({p, 3.0 * p, Time{}, TemperatureObservation{20.0F, 0.1F, 1.0F, 0.0F}});
    }
  }
  const ThermalMap map = mapOf(returns);
  const SurfaceLayer layer(map);
  for (std::uint32_t i = 0; i < layer.samples().size(); ++i) {
    const Eigen::Vector3d& p = layer[i].p_world;
    if (p.z() < 0.2 || p.z() > 0.8) continue;
    const Eigen::Vector3d radial = Eigen::Vector3d(p.x(), p.y(), 0.0).normalized();
    EXPECT_GT(std::abs(layer.normal(i).cast<double>().dot(radial)), std::cos(0.2));
  }
}

TEST(SurfaceLayer, HasNoNormalOnOneLineOfAScanner) {
  const ThermalMap map = mapOf(returnsOf({.width = 0.02, .line_step = 0.02}, uniform20, {.range = 0.0}));
  const SurfaceLayer layer(map);
  ASSERT_GT(layer.samples().size(), 20U);
  for (std::uint32_t i = 0; i < layer.samples().size(); ++i) {
    EXPECT_TRUE(layer.normal(i).isZero());
    EXPECT_FALSE(layer.onSameSurface(i, i));
  }
}

TEST(SurfaceLayer, TellsFloorFromWall) {
  std::vector<MappedReturn> returns = returnsOf({.origin = {0, 0, 0.02}}, uniform20);
  const PlanePatch wall{
      .origin = {1.52, 0, 0}, .along = Eigen::Vector3d::UnitY(), .across = Eigen::Vector3d::UnitZ()};
  for (const MappedReturn& one : returnsOf(wall, uniform20)) returns.push_back(one);
  const ThermalMap map = mapOf(returns);
  const SurfaceLayer layer(map);
  const auto nearest = [&](const Eigen::Vector3d& p) { return layer.within(p, 0.06).at(0); };
  const std::uint32_t floor = nearest({0.75, 0.75, 0.02}), floor_too = nearest({1.1, 0.4, 0.02});
  const std::uint32_t on_wall = nearest({1.52, 0.75, 0.75}), on_wall_too = nearest({1.52, 0.4, 1.1});
  EXPECT_TRUE(layer.onSameSurface(floor, floor_too));
  EXPECT_TRUE(layer.onSameSurface(on_wall, on_wall_too));
  EXPECT_FALSE(layer.onSameSurface(floor, on_wall));
  EXPECT_FALSE(layer.onSameSurface(on_wall, floor));
}

TEST(SurfaceLayer, IsTheSameOfPartsThatWereMergedInAnyOrder) {
  const ThermalMap a = plateWith({{{0.7, 0.7, 1.02}, 30.0, 0.06}}, {.seed = 1});
  const ThermalMap b = plateWith({}, {.seed = 2}, {.origin = {0.6, 0.3, 1.02}});
  ThermalMap ab(a.options()), ba(a.options());
  ab.merge(a);
  ab.merge(b);
  ba.merge(b);
  ba.merge(a);
  const SurfaceLayer one(ab), other(ba);
  ASSERT_EQ(one.samples().size(), other.samples().size());
  for (std::uint32_t i = 0; i < one.samples().size(); ++i) {
    ASSERT_EQ(one[i].key, other[i].key);
    ASSERT_EQ(one[i].p_world, other[i].p_world);
    ASSERT_EQ(one[i].celsius, other[i].celsius);
    ASSERT_EQ(one[i].sigma, other[i].sigma);
  }
}

TEST(SurfaceLayer, CanBeMoved) {
  const ThermalMap map = plateWith({});
  SurfaceLayer layer(map);
  const std::vector<std::uint32_t> before = layer.within({0.5, 0.5, 1.0}, 0.2);
  SurfaceLayer moved(std::move(layer));
  EXPECT_EQ(moved.within({0.5, 0.5, 1.0}, 0.2), before);
  EXPECT_FALSE(before.empty());
}

}  // namespace
}  // namespace thermovox
