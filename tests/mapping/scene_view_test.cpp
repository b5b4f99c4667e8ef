#include "mapping/scene_view.hpp"

#include <gtest/gtest.h>

#include "projection/error.hpp"
#include "tests/mapping/synthetic_scene.hpp"

namespace thermovox::test {
namespace {

const Camera& camera() {
  static const Camera one = sceneCamera();
  return one;
}

SceneView viewOf(const std::vector<const ThermalMap*>& maps, double range = 100.0) {
  SceneSurfaces scene(maps);
  return {camera(), Pose{}, scene, range, {}};
}

/// Share of the surfaces in the image that the view itself does not hide.
double shareVisible(const SceneView& view) {
  std::size_t visible = 0;
  for (const SceneView::Seen& seen : view.surfaces()) visible += !view.hides(seen.sight);
  return static_cast<double>(visible) / static_cast<double>(view.surfaces().size());
}

TEST(SceneView, APlateHidesWhatIsBehindItAndNothingElse) {
  const ThermalMap map = mapOf({kPlate, kWallBehind});
  const SceneView view = viewOf({&map});
  std::size_t behind = 0;
  std::size_t beside = 0;
  for (const Eigen::Vector3d& p : pointsOf({kWallBehind}, 9)) {
    const Eigen::Vector2d shadow = p.head<2>() * (2.02 / p.z());  // where its ray meets the plate's plane
    if (!camera().project(p)) continue;
    const bool hidden = view.hides(lookAt(camera(), p));
    const double outside = shadow.cwiseAbs().maxCoeff() - 0.5;  // metres past the plate's edge
    if (outside < -0.03) {
      ++behind;
      EXPECT_TRUE(hidden) << p.transpose();
    } else if (outside > 0.1) {
      ++beside;
      EXPECT_FALSE(hidden) << p.transpose();
    }
  }
  EXPECT_GT(behind, 10000U);
  EXPECT_GT(beside, 50000U);
  for (const Eigen::Vector3d& p : pointsOf({kPlate}, 9)) EXPECT_FALSE(view.hides(lookAt(camera(), p)));
}

TEST(SceneView, AFloorSeenAtAGrazingAngleDoesNotHideItself) {
  // y points down: a floor 0.4 m below the camera, seen at 63 to 80 degrees off its normal.
  const ThermalMap map = mapOf({{{-2.0, 0.41, 0.8}, {4, 0, 0}, {0, 0, 1.5}}});
  EXPECT_GT(shareVisible(viewOf({&map})), 0.995);
}

TEST(SceneView, ACylinderHidesItsFarSideOnly) {
  std::vector<MappedReturn> reading;
  const Eigen::Vector3d axis(0.0, 0.0, 3.0);
  const auto onCylinder = [&axis](double turn, double y) {
    return Eigen::Vector3d(axis + Eigen::Vector3d(0.4 * std::sin(turn), y, -0.4 * std::cos(turn)));
  };
  for (int i = 0; i < 240; ++i) {
    for (int j = -50; j < 50; ++j) {
      const Eigen::Vector3d p = onCylinder(i * 2 * M_PI / 240, 0.02 * j + 0.003);
      reading.push_back({p, p, Time{}, std::nullopt});
    }
  }
  ThermalMap map({.resolution = 0.05, .occupancy = {}});
  map.integrate(reading, Carving::none);
  const SceneView view = viewOf({&map});
  for (double turn = -1.2; turn < 1.2; turn += 0.01) {  // the limb is at 82 degrees, 1.44 rad
    EXPECT_FALSE(view.hides(lookAt(camera(), onCylinder(turn, 0.1)))) << turn;
    EXPECT_TRUE(view.hides(lookAt(camera(), onCylinder(M_PI + turn, 0.1)))) << turn;
  }
}

TEST(SceneView, WhatRaysHaveFreedHidesNothing) {
  const ThermalMap plate = mapOf({kPlate});
  const ThermalMap later = mapOf({kWallBehind}, Carving::octomap);  // the plate has gone
  const Eigen::Vector3d behind(0.1, 0.1, 5.0);
  EXPECT_TRUE(viewOf({&plate, &later}).hides(lookAt(camera(), behind)));  // once hit, once passed
  EXPECT_FALSE(viewOf({&plate, &later, &later, &later}).hides(lookAt(camera(), behind)));
}

TEST(SceneView, ASlimPoleHitHereAndThereHidesWhatIsBehindIt) {
  // Lines of a scan, 10 cm apart, leave every other cell of the pole empty; behind it the wall has a shadow.
  ThermalMap map =
      mapOf({{{-5, -4, 5.02}, {4.9, 0, 0}, {0, 8, 0}}, {{0.1, -4, 5.02}, {4.9, 0, 0}, {0, 8, 0}}});
  std::vector<MappedReturn> reading;
  for (int i = -20; i <= 20; ++i) {
    for (const double x : {-0.03, 0.0, 0.03}) {
      const Eigen::Vector3d p(x, 0.1 * i + 0.01, 2.02);
      reading.push_back({p, p, Time{}, std::nullopt});
    }
  }
  map.integrate(reading, Carving::none);
  const SceneView view = viewOf({&map});
  for (double y = -2.0; y < 2.0; y += 0.05) {
    EXPECT_TRUE(view.hides(lookAt(camera(), {0.0, y, 5.02}))) << y;
    EXPECT_FALSE(view.hides(lookAt(camera(), {0.5, y, 5.02}))) << y;
  }
}

TEST(SceneView, FartherSurfacesThanItsRangeAreNotInIt) {
  const ThermalMap map = mapOf({kPlate, kWallBehind});
  const SceneView near = viewOf({&map}, 3.0);
  for (const SceneView::Seen& seen : near.surfaces()) EXPECT_LE(seen.surface.p_world.norm(), 3.0);
  EXPECT_FALSE(viewOf({&map}, 1.0).hides(lookAt(camera(), {0.1, 0.1, 5.0})));
}

TEST(SceneView, OptionsAreChecked) {
  EXPECT_THROW(SceneView::Options{.disc_radius = 0.0}.validate(), ConfigError);
  EXPECT_THROW(SceneView::Options{.slope = std::nan("")}.validate(), ConfigError);
  EXPECT_THROW(SceneView::Options{.margin = -1.0}.validate(), ConfigError);
}

}  // namespace
}  // namespace thermovox::test
