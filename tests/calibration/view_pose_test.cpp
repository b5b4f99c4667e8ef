#include "calibration/view_pose.hpp"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

TEST(PoseFromView, FindsTheBoardForEveryLens) {
  const CalibrationBoard board = plate();
  Chance chance(3);
  for (const LensModel model : {LensModel::pinhole, LensModel::brown_conrady, LensModel::kannala_brandt}) {
    const Intrinsics lens = lensOf(model);
    for (const Pose& truth : boardsHeld(20, 3)) {
      const auto found =
          poseFromView(boardPoints(board), viewOf(lens, truth, board, 0.0, chance), Camera(lens));
      ASSERT_TRUE(found);
      // OpenCV's IPPE keeps its homography in double, conditioned by about 1e3: 1e-6 leaves a margin.
      EXPECT_LT(found->rotation.angularDistance(truth.rotation), 1e-6);
      EXPECT_THAT(found->translation, IsNear(truth.translation, 1e-6));
    }
  }
}

TEST(PoseFromView, StaysNearWithNoise) {
  const CalibrationBoard board = plate();
  const Intrinsics lens = lensOf(LensModel::brown_conrady);
  Chance chance(4);
  for (const Pose& truth : boardsHeld(40, 4)) {
    const auto found =
        poseFromView(boardPoints(board), viewOf(lens, truth, board, 0.1, chance), Camera(lens));
    ASSERT_TRUE(found);
    // A board of 0.42 m at 1.8 m is 35 px wide: a tilt of 15 degrees shortens it by 1.2 px, and 0.1 px of 40
    // corners is about 3 degrees of tilt there. It is a start that has to be on the right side, not a result.
    EXPECT_LT(found->rotation.angularDistance(truth.rotation), 12.0 * kDegree);
    EXPECT_LT((found->translation - truth.translation).norm(), 0.03 * truth.translation.norm());
  }
}

TEST(PoseFromView, NeedsFourCornersWithARay) {
  const Intrinsics lens = lensOf(LensModel::brown_conrady);
  Chance chance(5);
  const CalibrationBoard board = plate();
  BoardView view = viewOf(lens, boardsHeld(1, 5).front(), board, 0.0, chance);
  EXPECT_TRUE(poseFromView(boardPoints(board), view, Camera(lens)));
  // Beyond where the lens folds back no ray leads to a pixel.
  for (std::size_t i = 3; i < view.size(); ++i) view[i].pixel = {4000.0, 4000.0};
  EXPECT_FALSE(poseFromView(boardPoints(board), view, Camera(lens)));
}

TEST(PoseFromView, TakesNoBoardWithoutExtent) {
  const Intrinsics lens = lensOf(LensModel::pinhole);
  const CalibrationBoard board = plate();
  const BoardView point(40, BoardCorner{{80.0, 60.0}, Eigen::Matrix2d::Identity(), 10.0});
  const auto found = poseFromView(boardPoints(board), point, Camera(lens));
  EXPECT_TRUE(!found || found->translation.allFinite()) << "never a pose that is no number";
}

}  // namespace
}  // namespace thermovox::test
