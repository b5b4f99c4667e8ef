#include "mapping/scene_surfaces.hpp"

#include <gtest/gtest.h>

#include <set>

#include "projection/error.hpp"
#include "tests/mapping/synthetic_scene.hpp"

namespace thermovox::test {
namespace {

std::vector<SceneSurface> inView(SceneSurfaces& scene, double range = 100.0,
                                 const Pose& T_camera_world = {}) {
  std::vector<SceneSurface> surfaces;
  scene.forEachInView(sceneCamera(), T_camera_world, range,
                      [&surfaces](const SceneSurface& surface) { surfaces.push_back(surface); });
  return surfaces;
}

TEST(SceneSurfaces, HoldEverySurfaceInTheImageOnce) {
  const ThermalMap map = mapOf({kPlate, kWallBehind});
  SceneSurfaces scene({&map});
  std::set<CellKey> found;
  for (const SceneSurface& surface : inView(scene)) {
    EXPECT_TRUE(found.insert(surface.key).second);
    EXPECT_EQ(map.keyOf(surface.p_world), surface.key);
  }
  forEachSurface(map, [&](const CellKey& key, const SurfaceCell&) {
    EXPECT_TRUE(found.contains(key) || !sceneCamera().project(map.centerOf(key)));
  });
}

TEST(SceneSurfaces, KnowTheNormalsOfAWallAlsoAcrossTilesAndNoneOfALonePoint) {
  ThermalMap map = mapOf({kWallBehind});
  const Eigen::Vector3d alone(0.0, 0.0, 3.0);
  map.integrate(std::vector{MappedReturn{alone, alone, Time{}, std::nullopt}}, Carving::none);
  SceneSurfaces scene({&map});
  std::size_t walls = 0;
  for (const SceneSurface& surface : inView(scene)) {
    if (surface.key == map.keyOf(alone)) {
      EXPECT_TRUE(surface.normal.isZero());
    } else if (surface.p_world.head<2>().cwiseAbs().maxCoeff() < 3.5) {  // not at its ends
      ++walls;
      EXPECT_GT(std::abs(surface.normal.z()), 0.9F) << surface.p_world.transpose();
    }
  }
  EXPECT_GT(walls, 10000U);  // 7 m and more across: tiles are 3.2 m wide
}

TEST(SceneSurfaces, AnswerForAPointAsForAView) {
  ThermalMap map = mapOf({kPlate, kWallBehind});
  SceneSurfaces scene({&map}), asked({&map});
  for (const SceneSurface& surface : inView(scene)) {
    SCOPED_TRACE(testing::Message() << surface.p_world.transpose());
    const SceneSurface* answer = asked.surfaceAt(surface.p_world);
    ASSERT_NE(answer, nullptr);
    EXPECT_EQ(answer->key, surface.key);
    EXPECT_EQ(answer->normal, surface.normal);
  }
  EXPECT_EQ(asked.surfaceAt({0.0, 0.0, 1.0}), nullptr);     // nothing there
  EXPECT_EQ(asked.surfaceAt({900.0, 0.0, -1.0}), nullptr);  // nor anywhere near
}

TEST(SceneSurfaces, LeaveOutWhatIsBehindTheCameraOrTooFar) {
  const ThermalMap map = mapOf({kPlate, kWallBehind});
  SceneSurfaces scene({&map});
  const Pose turned{expRotation({0.0, M_PI, 0.0}), {0.0, 0.0, -20.0}};
  EXPECT_TRUE(inView(scene, 100.0, turned).empty());
  for (const SceneSurface& surface : inView(scene, 0.5)) EXPECT_LT(surface.p_world.norm(), 0.5 + 2 * 5.6);
  EXPECT_LT(inView(scene, 0.5).size(), inView(scene).size());
}

TEST(SceneSurfaces, ForgetTilesAndGatherThemAgain) {
  const ThermalMap map = mapOf({kPlate, kWallBehind});
  SceneSurfaces scene({&map});
  const std::vector<SceneSurface> before = inView(scene);
  const Pose turned{expRotation({0.0, M_PI, 0.0}), {0.0, 0.0, -20.0}};
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(inView(scene, 100.0, turned).empty());
  const std::vector<SceneSurface> after = inView(scene);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].key, after[i].key);
    EXPECT_EQ(before[i].p_world, after[i].p_world);
    EXPECT_EQ(before[i].normal, after[i].normal);
  }
}

TEST(SceneSurfaces, OfSeveralMapsAreThoseOfTheMergedOne) {
  const ThermalMap plate = mapOf({kPlate});
  const ThermalMap wall = mapOf({kWallBehind}, Carving::octomap);  // sees through where the plate is
  ThermalMap merged({.resolution = 0.05, .occupancy = {}});
  merged.merge(plate);
  for (int i = 0; i < 3; ++i) merged.merge(wall);
  SceneSurfaces apart({&plate, &wall, &wall, &wall});
  SceneSurfaces together({&merged});
  const std::vector<SceneSurface> a = inView(apart);
  const std::vector<SceneSurface> b = inView(together);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].key, b[i].key);
    EXPECT_EQ(a[i].p_world, b[i].p_world);
  }
}

TEST(SceneSurfaces, RefuseMapsThatDoNotFitTogether) {
  const ThermalMap fine({.resolution = 0.05, .occupancy = {}});
  const ThermalMap coarse({.resolution = 0.1, .occupancy = {}});
  EXPECT_THROW(SceneSurfaces({&fine, &coarse}), ConfigError);
  EXPECT_THROW(SceneSurfaces({}), ConfigError);
}

}  // namespace
}  // namespace thermovox::test
