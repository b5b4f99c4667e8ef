#include "calibration/noise_model.hpp"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {
namespace {

/// Corners that say they are half as far off as they are.
BundleScene overconfident() {
  BundleScene scene = made({.captures = 12,
                            .cameras = 2,
                            .corner_sigma_px = 0.1,
                            .range_sigma = 0.005,
                            .range_bias_sigma = 0.005,
                            .seed = 1});
  for (CaptureObservations& capture : scene.data.captures) {
    for (CornerObservation& corner : capture.corners) {
      if (corner.camera == 1) corner.covariance *= 0.25;
    }
  }
  return scene;
}

TEST(DropCornerOutliers, DropsThePlantedOnesOfEachCamera) {
  BundleScene scene = made({.captures = 6, .cameras = 2, .corner_sigma_px = 0.1, .seed = 2});
  std::size_t all = 0;
  for (CaptureObservations& capture : scene.data.captures) all += capture.corners.size();
  scene.data.captures[1].corners[3].pixel.x() += 3.0;   // of the first camera
  scene.data.captures[4].corners[17].pixel.y() -= 2.0;  // likewise
  scene.data.captures[2].corners[55].pixel.y() += 4.0;  // of the second
  const std::vector<int> dropped = dropCornerOutliers(scene.data, scene.truth, scene.model);
  ASSERT_EQ(dropped.size(), 2U);
  // Besides the planted ones, of 480 numbers of a camera 0.2 are beyond 3.5 sigmas by chance.
  EXPECT_GE(dropped[0], 2);
  EXPECT_LE(dropped[0], 4);
  EXPECT_GE(dropped[1], 1);
  EXPECT_LE(dropped[1], 3);
  std::size_t left = 0;
  for (const CaptureObservations& capture : scene.data.captures) {
    left += capture.corners.size();
    for (const CornerObservation& corner : capture.corners) {
      const auto capture_index = static_cast<std::size_t>(&capture - scene.data.captures.data());
      EXPECT_FALSE(corner.camera == 0 && corner.point == 3 && capture_index == 1);
      EXPECT_FALSE(corner.camera == 0 && corner.point == 17 && capture_index == 4);
      EXPECT_FALSE(corner.camera == 1 && corner.point == 15 && capture_index == 2);
    }
  }
  EXPECT_EQ(left, all - static_cast<std::size_t>(dropped[0] + dropped[1]));
}

TEST(DropCornerOutliers, GoesByWhatCornersScatterNotByWhatTheySay) {
  BundleScene scene = overconfident();
  const std::vector<int> dropped = dropCornerOutliers(scene.data, scene.truth, scene.model);
  EXPECT_LE(dropped[0], 4) << "0.4 by chance";
  EXPECT_LE(dropped[1], 4) << "although all are twice as far off as they say";
}

TEST(DropEdgeOutliers, DropsAPlantedCrossing) {
  Chance chance(3);
  BundleScene scene = made({.captures = 6, .seed = 3, .edges = BundleScene::Edges::exact});
  for (CaptureObservations& capture : scene.data.captures) {
    for (EdgeSide& side : capture.edges) {
      side.offset_sigma = 0.0;
      for (EdgeCrossing& crossing : side.crossings) crossing.place += chance.normal(crossing.sigma);
    }
  }
  scene.data.captures[2].edges[1].crossings[0].place += 0.05;
  EdgeSide& lone = scene.data.captures[4].edges[3];
  lone.crossings.resize(1);
  lone.crossings[0].place -= 0.05;
  const int dropped = dropEdgeOutliers(scene.data, scene.truth, scene.model);
  EXPECT_GE(dropped, 2);
  EXPECT_LE(dropped, 3);
  EXPECT_EQ(scene.data.captures[2].edges[1].crossings.size(), 2U);
  EXPECT_EQ(scene.data.captures[4].edges.size(), 3U) << "no side without crossings stays";
}

TEST(DropEdgeOutliers, HasNothingToDoWithoutEdges) {
  BundleScene scene = made({.captures = 3});
  EXPECT_EQ(dropEdgeOutliers(scene.data, scene.truth, scene.model), 0);
}

TEST(FitWithNoise, RecoversHowFarCornersReallyErr) {
  BundleScene scene = overconfident();
  const BundleFit fit = fitWithNoise(scene.data, scene.truth, scene.model);
  EXPECT_TRUE(fit.converged);
  // 12 captures of 40 corners: 960 numbers less some 80 unknowns, four standard errors are 10 per cent.
  EXPECT_NEAR(scene.model.corner_factor[0], 1.0, 0.10);
  EXPECT_NEAR(scene.model.corner_factor[1], 2.0, 0.20);
}

TEST(FitWithNoise, LeavesPlanesAloneThatFit) {
  int left = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    BundleScene scene = made({.captures = 12,
                              .corner_sigma_px = 0.1,
                              .range_sigma = 0.005,
                              .range_bias_sigma = 0.005,
                              .seed = seed});
    (void)fitWithNoise(scene.data, scene.truth, scene.model);
    left += scene.model.plane_factor == 1.0 ? 1 : 0;
  }
  EXPECT_GE(left, 4);  // a test at 5 per cent fails once in twenty
}

TEST(FitWithNoise, SeesThatPlanesErrMoreThanTheirReturnsSay) {
  BundleScene scene = made({.captures = 16, .corner_sigma_px = 0.05, .range_sigma = 0.005, .seed = 4});
  for (CaptureObservations& capture : scene.data.captures) {
    capture.plane->slope *= 3.0;  // they say they are three times as exact as they are
    capture.plane->offset *= 3.0;
  }
  (void)fitWithNoise(scene.data, scene.truth, scene.model);
  // 64 numbers less 6 unknowns and what the biases take: about 45, four standard errors are 40 per cent.
  EXPECT_NEAR(std::log(scene.model.plane_factor / 3.0), 0.0, 0.4);
}

TEST(FitWithNoise, FitsCamerasWithoutALaser) {
  BundleScene scene = made({.captures = 8, .corner_sigma_px = 0.1, .seed = 5});
  for (CaptureObservations& capture : scene.data.captures) capture.plane.reset();
  const double before = scene.model.range_bias_sigma;
  const BundleFit fit = fitWithNoise(scene.data, scene.truth, scene.model);
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(scene.model.plane_factor, 1.0);
  EXPECT_EQ(scene.model.edge_factor, 1.0);
  EXPECT_EQ(scene.model.edge_offset_sigma, 0.0);
  EXPECT_EQ(scene.model.range_bias_sigma, before) << "there are no ranges to learn it from";
}

}  // namespace
}  // namespace thermovox::test
