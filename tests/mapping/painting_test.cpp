#include "mapping/painting.hpp"

#include <gtest/gtest.h>

#include <concepts>
#include <utility>

#include "tests/mapping/synthetic_scene.hpp"
#include "tests/projection/scene.hpp"
#include "tests/support/radiometry.hpp"

namespace thermovox::test {
namespace {

ThermalCamera thermalCamera() {
  return {.camera = sceneCamera(), .T_body_camera = {}, .netd = 0.05, .blur_px = 0.7};
}

/// Paints one frame, taken from the origin, of all that `scene_maps` hold onto `map`.
void paintOnce(const std::vector<const ThermalMap*>& scene_maps, ThermalImage image, ThermalMap& map) {
  const ThermalCamera camera = thermalCamera();
  const ThermalView view(frameOf(std::move(image), Time(std::chrono::seconds(7))), Pose{}, camera);
  SceneSurfaces scene(scene_maps);
  const SceneView scene_view(camera.camera, Pose{}, scene, paintRange(camera, map.resolution()), {});
  paint(view, camera, scene_view, {.range_sigma = 0.01}, map);
}
template <std::invocable<int, int> Celsius>
void paintOnce(const std::vector<const ThermalMap*>& scene_maps, const Celsius& celsius, ThermalMap& map) {
  paintOnce(scene_maps, imageOf(160, 120, celsius), map);
}

TEST(Painting, ColoursEverySurfaceThatTheFrameSeesOnce) {
  ThermalMap map = mapOf({kPlate, kWallBehind});
  paintOnce(
      {&map}, [](int, int) { return 55.0; }, map);
  std::size_t painted = 0;
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell& cell) {
    const Eigen::Vector3d p = map.centerOf(key);
    const bool behind = p.z() > 3.0 && (p.head<2>() * (2.0 / p.z())).cwiseAbs().maxCoeff() < 0.4;
    const auto pixel = sceneCamera().project(p);
    const bool inside = pixel && pixel->x() > 3 && pixel->y() > 3 && pixel->x() < 156 && pixel->y() < 116;
    if (behind) {
      EXPECT_EQ(cell.observations, 0U) << p.transpose();
    }
    if (inside && p.z() < 3.0) {
      EXPECT_EQ(cell.observations, 1U) << p.transpose();
    }
    if (cell.observations == 0) return;
    ++painted;
    EXPECT_NEAR(cell.mean(), 55.0, 0.01);
    EXPECT_NEAR(cell.sigmaOfMean(), 0.05, 0.03);
    EXPECT_NEAR(toSeconds(cell.last() - Time(std::chrono::seconds(7))), 0.0, 1e-4);
  });
  EXPECT_GT(painted, 15000U);
}

TEST(Painting, KnowsTheIncidenceOnAWall) {
  ThermalMap map = mapOf({kWallBehind});
  paintOnce(
      {&map}, [](int, int) { return 20.0; }, map);
  const Eigen::Vector3d aside(2.0, 1.0, 5.02);
  const SurfaceCell* cell = map.surface(map.keyOf(aside));
  ASSERT_TRUE(cell != nullptr && cell->observations == 1);
  EXPECT_NEAR(cell->bestView().incidence, std::atan2(std::hypot(2.0, 1.0), 5.02), 0.2);
  EXPECT_NEAR(cell->bestView().range, aside.norm(), 0.06);
}

TEST(Painting, AGrazingViewIsWorthTheSameHoweverOftenItIsTaken) {
  // A floor 1 m below the camera, which sees it at 74 degrees: the frame's surroundings have 20 C.
  const ThermalMap floor = mapOf({{{-1.0, 1.02, 1.0}, {2, 0, 0}, {0, 0, 5}}});
  ThermalMap once({.resolution = 0.05, .occupancy = {}}), often({.resolution = 0.05, .occupancy = {}});
  const auto warm = [](int, int) { return 60.0; };
  paintOnce({&floor}, warm, once);
  for (int i = 0; i < 50; ++i) paintOnce({&floor}, warm, often);
  const CellKey key = floor.keyOf({0.01, 1.02, 3.51});
  const SurfaceCell* one = once.surface(key);
  const SurfaceCell* many = often.surface(key);
  ASSERT_TRUE(one != nullptr && many != nullptr && many->observations == 50);
  EXPECT_NEAR(one->bestView().incidence, std::atan2(3.5, 1.02), 0.1);  // noisy normals
  EXPECT_GT(one->sigmaOfMean(), 4.0);
  EXPECT_NEAR(many->sigmaOfMean(), one->commonSigma(), 0.05);
  EXPECT_EQ(many->commonSigma(), one->commonSigma());
}

TEST(Painting, PutsTheAirOfItsOwnDistanceIntoEveryCell) {
  ThermalMap map = mapOf({kWallBehind});
  RadiometricParameters parameters = sc660();
  parameters.atmosphere_temperature = 35.0;
  parameters.humidity = 1.0;
  const AirPath air(parameters);
  ThermalImage image = imageOf(160, 120, [](int, int) { return 120.0; });
  image.air = std::make_shared<const AirPath>(parameters);
  paintOnce({&map}, std::move(image), map);
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(0.0, 0.0, 5.02), Eigen::Vector3d(2.0, 1.0, 5.02)}) {
    const SurfaceCell* cell = map.surface(map.keyOf(place));
    ASSERT_TRUE(cell != nullptr && cell->observations == 1);
    const double expected = air.at(120.0, cell->bestView().range).celsius;
    EXPECT_GT(expected, 121.0);
    EXPECT_NEAR(cell->mean(), expected, 0.01) << place.transpose();  // what a cell stores
  }
}

TEST(Painting, ACellOnAnEdgeOfTemperaturesDistrustsItself) {
  ThermalMap map = mapOf({kWallBehind});
  paintOnce(
      {&map}, [](int u, int) { return u < 80 ? 20.0 : 60.0; }, map);
  const SurfaceCell* edge = map.surface(map.keyOf({0.0, 0.3, 5.02}));
  const SurfaceCell* away = map.surface(map.keyOf({1.5, 0.3, 5.02}));
  ASSERT_TRUE(edge != nullptr && away != nullptr);
  EXPECT_GT(edge->sigmaOfMean(), 5.0);
  EXPECT_LT(away->sigmaOfMean(), 0.1);
}

TEST(Painting, SurfacesOfAnotherMapAreColouredWithoutBecomingThisMapsGeometry) {
  const ThermalMap known = mapOf({kWallBehind});
  ThermalMap own = mapOf({kPlate});
  const std::size_t before = own.surfaceCount();
  paintOnce(
      {&known, &own}, [](int, int) { return 33.0; }, own);
  EXPECT_GT(own.surfaceCount(), before + 10000);
  const CellKey aside = own.keyOf({1.5, 1.0, 5.02});
  ASSERT_NE(own.surface(aside), nullptr);
  EXPECT_EQ(own.surface(aside)->returns, 0U);
  EXPECT_TRUE(own.surface(aside)->isPlausible());
  EXPECT_EQ(own.occupancy(aside), Occupancy::unknown);
  ThermalMap together({.resolution = 0.05, .occupancy = {}});
  together.merge(own);
  together.merge(known);
  EXPECT_EQ(together.surface(aside)->meanOffset(), known.surface(aside)->meanOffset());
  EXPECT_NEAR(together.surface(aside)->mean(), 33.0, 0.01);
}

TEST(Painting, EndsWhereAPixelIsWiderThanFourCells) {
  EXPECT_DOUBLE_EQ(paintRange(thermalCamera(), 0.05), 20.0);
  ThermalMap map = mapOf({{{-1, -1, 21.02}, {2, 0, 0}, {0, 2, 0}}});
  paintOnce(
      {&map}, [](int, int) { return 20.0; }, map);
  forEachSurface(map, [](const CellKey&, const SurfaceCell& cell) { EXPECT_EQ(cell.observations, 0U); });
}

}  // namespace
}  // namespace thermovox::test
