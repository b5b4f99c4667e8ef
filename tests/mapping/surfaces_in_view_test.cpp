#include "mapping/surfaces_in_view.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace thermovox {
namespace {

/// 160 x 120 pixels over 77 by 62 degrees.
Camera wideCamera() {
  Intrinsics in{.width_px = 160, .height_px = 120, .model = LensModel::pinhole};
  in.parameters[kFx] = in.parameters[kFy] = 100.0;
  in.parameters[kCx] = 79.5;
  in.parameters[kCy] = 59.5;
  return Camera(in);
}

// Camera and world are one frame, the laser stands in its origin: the optical axis is the world's z.
constexpr double kPlate = 2.04;  // metres ahead

/// A plate of 1 x 1 m there, `scale` times as far and as big.
std::vector<MappedReturn> plate(double scale) {
  std::vector<MappedReturn> reading;
  for (int i = -25; i <= 25; ++i) {
    for (int j = -25; j <= 25; ++j) {
      const Eigen::Vector3d p(0.02 * i + 0.001, 0.02 * j + 0.001, kPlate);
      reading.push_back({scale * p, Eigen::Vector3d::Zero(), Time{}, std::nullopt});
    }
  }
  return reading;
}

ThermalMap mapOfPlate(double scale) {
  ThermalMap map({.resolution = 0.05});
  map.integrate(plate(scale), Carving::octomap);
  return map;
}

/// Depth beyond which the map hides what lies at a pixel of a camera there.
float hiddenBeyond(const ThermalMap& map, const Eigen::Vector2d& pixel, const Pose& T_camera_world = {}) {
  const Camera camera = wideCamera();
  DepthSectors depths(camera, T_camera_world, {});
  addSurfacesInView(map, ViewCone(camera, T_camera_world, 100.0), depths);
  depths.finish();
  return depths.hiddenBeyond(pixel);
}

constexpr float kNowhere = std::numeric_limits<float>::infinity();
const Eigen::Vector2d kMiddle(80.0, 60.0);

TEST(SurfacesInView, HideWhatIsBehindThem) {
  const ThermalMap map = mapOfPlate(1.0);
  EXPECT_GT(hiddenBeyond(map, kMiddle), kPlate);
  EXPECT_LT(hiddenBeyond(map, kMiddle), kPlate + 0.5);
  EXPECT_EQ(hiddenBeyond(map, {5.0, 5.0}), kNowhere);  // past the plate's edge
}

TEST(SurfacesInView, HideNoMoreOnceRaysHaveFreedThem) {
  ThermalMap map = mapOfPlate(1.0);
  const CellKey middle = map.keyOf({0.001, 0.001, kPlate});
  for (int i = 0; i < 5; ++i) map.integrate(plate(2.0), Carving::octomap);  // seen through where it stood
  ASSERT_EQ(map.occupancy(middle), Occupancy::free);
  ASSERT_NE(map.surface(middle), nullptr);  // it keeps its statistics
  EXPECT_GT(hiddenBeyond(map, kMiddle), 2.0 * kPlate);
  EXPECT_LT(hiddenBeyond(map, kMiddle), 2.0 * kPlate + 1.0);
}

TEST(SurfacesInView, DoNothingBehindTheCamera) {
  const ThermalMap map = mapOfPlate(-1.0);
  EXPECT_EQ(hiddenBeyond(map, kMiddle), kNowhere);
  const Pose turned{expRotation({0.0, M_PI, 0.0}), {0.0, 0.0, 0.0}};  // has the plate before it
  EXPECT_LT(hiddenBeyond(map, kMiddle, turned), kPlate + 0.5);
}

}  // namespace
}  // namespace thermovox
