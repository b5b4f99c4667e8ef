#include "mapping/view_cone.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/mapping/synthetic_scene.hpp"

namespace thermovox::test {
namespace {

TEST(ViewCone, HoldsAllThatTheImageAndItsRimShow) {
  const Camera camera = sceneCamera();
  const Pose T_camera_world{expRotation({0.3, -0.7, 0.2}), {1.0, 2.0, 3.0}};
  const ViewCone cone(camera, T_camera_world, 20.0);
  std::mt19937_64 rng(8);
  std::uniform_real_distribution<double> u(-7.0, 167.0), v(-7.0, 127.0), distance(0.1, 19.9);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d d_camera((u(rng) - 79.5) / 100.0, (v(rng) - 59.5) / 100.0, 1.0);
    const Eigen::Vector3d p_world = T_camera_world.inverse() * (distance(rng) * d_camera.normalized());
    EXPECT_TRUE(cone.mayHold(p_world, 0.0)) << p_world.transpose();
  }
}

TEST(ViewCone, DoesNotHoldWhatIsBehindBesideOrTooFar) {
  const ViewCone cone(sceneCamera(), Pose{}, 20.0);
  EXPECT_TRUE(cone.mayHold({0, 0, 19}, 0.0));
  EXPECT_FALSE(cone.mayHold({0, 0, 21}, 0.5));
  EXPECT_TRUE(cone.mayHold({0, 0, 21}, 1.5));
  EXPECT_FALSE(cone.mayHold({0, 0, -3}, 1.0));
  EXPECT_TRUE(cone.mayHold({0, 0, -3}, 3.5));  // the camera is in it
  EXPECT_FALSE(cone.mayHold({10, 0, 2}, 1.0));
}

}  // namespace
}  // namespace thermovox::test
