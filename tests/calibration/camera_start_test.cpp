#include "calibration/camera_start.hpp"

#include <gtest/gtest.h>

#include "projection/error.hpp"
#include "tests/calibration/rig_trial.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

RigTrial bothCameras(std::uint64_t seed) {
  return drawn(
      {.captures = 10, .seed = seed, .cameras = RigTrial::Cameras::both, .laser = RigTrial::Laser::silent});
}

/// Whether a view is in the order of the board as its pose has it: each corner within a few pixels.
bool isInOrder(const RigTrial& trial, const CameraStart& start, std::size_t capture, std::size_t camera) {
  const Pose T_camera_board =
      start.estimate.T_camera_reference[camera] * start.estimate.T_reference_board[capture];
  const Intrinsics& lens = start.estimate.cameras[camera];
  const auto points = boardPoints(trial.input.board);
  const BoardView& view = start.captures[capture].views[camera].value();
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel =
        pixelFromCamera<double>(lens.model, lens.parameters.data(), T_camera_board * points[i]);
    worst = std::max(worst, (pixel - view[i].pixel).norm() / lens.width_px);
  }
  return worst < 0.02;  // a square is 0.03 of the image's width and more
}

void expectStart(const RigTrial& trial, const CameraStart& start) {
  // Ten boards of 54 corners with 0.1 px know the focal length to about 0.8 px: four standard errors.
  EXPECT_NEAR(start.estimate.cameras[0].parameters[kFx], trial.truth.cameras[0].parameters[kFx], 3.0);
  for (std::size_t camera = 1; camera < start.estimate.cameras.size(); ++camera) {
    const Pose& found = start.estimate.T_camera_reference[camera];
    EXPECT_LT(found.rotation.angularDistance(trial.truth.T_camera_reference[camera].rotation), 2.0 * kDegree);
    EXPECT_THAT(found.translation, IsNear(trial.truth.T_camera_reference[camera].translation, 0.03));
  }
  for (std::size_t i = 0; i < start.captures.size(); ++i) {
    for (std::size_t camera = 0; camera < start.estimate.cameras.size(); ++camera) {
      if (!start.captures[i].views[camera]) continue;
      EXPECT_TRUE(isInOrder(trial, start, i, camera)) << "capture " << i << ", camera " << camera;
    }
  }
}

TEST(StartCameras, FindsLensesBoardsAndTheSecondCamera) {
  const RigTrial trial = bothCameras(1);
  const CameraStart start = startCameras(trial.input);
  expectStart(trial, start);
  EXPECT_TRUE(start.dropped.empty());
}

TEST(StartCameras, TurnsViewsBackThatBeginAtTheOtherSide) {
  RigTrial trial = bothCameras(2);
  const auto half_turn = boardSymmetries(trial.input.board)[1];
  for (const std::size_t i : {1U, 4U, 5U, 8U})
    trial.input.captures[i].views[1] = turnedView(*trial.input.captures[i].views[1], half_turn);
  trial.input.captures[4].views[0] = turnedView(*trial.input.captures[4].views[0], half_turn);
  const CameraStart start = startCameras(trial.input);
  expectStart(trial, start);
  EXPECT_TRUE(start.dropped.empty());
}

TEST(StartCameras, TurnsViewsOfASquareGridByQuarters) {
  RigTrial trial = bothCameras(3);
  trial.input.board.columns = trial.input.board.rows = 7;
  trial.input.board.width = trial.input.board.height = 0.0;
  const auto symmetries = boardSymmetries(trial.input.board);
  ASSERT_EQ(symmetries.size(), 4U);
  Chance chance(3);
  for (std::size_t i = 0; i < trial.input.captures.size(); ++i) {
    for (std::size_t camera = 0; camera < 2; ++camera) {
      const BoardView view = viewOf(trial.truth.cameras[camera],
                                    trial.truth.T_camera_reference[camera] * trial.truth.T_reference_board[i],
                                    trial.input.board, 0.1, chance);
      trial.input.captures[i].views[camera] = turnedView(view, symmetries[(i + 2 * camera + i * camera) % 4]);
    }
  }
  const CameraStart start = startCameras(trial.input);
  expectStart(trial, start);
  EXPECT_TRUE(start.dropped.empty());
}

TEST(StartCameras, LeavesOutAViewWhoseBoardMoved) {
  RigTrial trial = bothCameras(4);
  Chance chance(4);
  const Pose moved_board{trial.truth.T_reference_board[6].rotation,
                         trial.truth.T_reference_board[6].translation + Eigen::Vector3d(0.15, 0.1, 0.1)};
  trial.input.captures[6].views[1] =
      viewOf(trial.truth.cameras[1], trial.truth.T_camera_reference[1] * moved_board, trial.input.board, 0.1,
             chance);
  const CameraStart start = startCameras(trial.input);
  ASSERT_EQ(start.dropped.size(), 1U);
  EXPECT_EQ(start.dropped.front().capture, "capture 6");
  EXPECT_FALSE(start.captures[6].views[1]);
  EXPECT_TRUE(start.captures[6].views[0]);
  expectStart(trial, start);
}

TEST(StartCameras, FindsALensThatTheInputHasWrong) {
  RigTrial trial = bothCameras(5);
  for (CameraGuess& guess : trial.input.cameras) {
    guess.intrinsics.parameters[kFx] *= 3.0;
    guess.intrinsics.parameters[kFy] *= 3.0;
  }
  expectStart(trial, startCameras(trial.input));
}

TEST(StartCameras, KeepsALensThatIsToBeKept) {
  RigTrial trial = bothCameras(6);
  trial.input.cameras[0].intrinsics = trial.truth.cameras[0];
  trial.input.cameras[0].lens = CameraGuess::Lens::keep;
  const CameraStart start = startCameras(trial.input);
  EXPECT_EQ(start.estimate.cameras[0].parameters, trial.truth.cameras[0].parameters);
  expectStart(trial, start);
}

TEST(StartCameras, KnowsABoardThatOnlyTheSecondCameraSaw) {
  RigTrial trial = bothCameras(7);
  trial.input.captures[3].views[0].reset();
  const CameraStart start = startCameras(trial.input);
  expectStart(trial, start);
  EXPECT_LT(
      (start.estimate.T_reference_board[3].translation - trial.truth.T_reference_board[3].translation).norm(),
      0.05);
}

TEST(StartCameras, TakesASecondCameraWithoutViewsAsTheInputHasIt) {
  RigTrial trial = bothCameras(8);
  for (BoardCapture& capture : trial.input.captures) capture.views[1].reset();
  const CameraStart start = startCameras(trial.input);
  EXPECT_EQ(start.estimate.T_camera_reference[1], trial.input.cameras[1].T_reference_camera.inverse());
  EXPECT_EQ(start.estimate.cameras[1].parameters, trial.input.cameras[1].intrinsics.parameters);
}

TEST(StartCameras, NeedsAViewOfTheReferenceCamera) {
  RigTrial trial = bothCameras(9);
  for (BoardCapture& capture : trial.input.captures) capture.views[0].reset();
  EXPECT_THROW((void)startCameras(trial.input), UnobservableError);
  trial.input.captures.clear();
  EXPECT_THROW((void)startCameras(trial.input), UnobservableError);
}

TEST(CornersOf, HaveTheViewsCovarianceAndALittleMore) {
  const BoardView view{{{10.0, 20.0}, 0.01 * Eigen::Matrix2d::Identity(), 5.0},
                       {{11.0, 21.0}, Eigen::Matrix2d::Zero(), 5.0}};
  const auto corners = cornersOf(view, 1);
  ASSERT_EQ(corners.size(), 2U);
  EXPECT_EQ(corners[1].point, 1);
  EXPECT_EQ(corners[1].camera, 1);
  EXPECT_EQ(corners[1].pixel, view[1].pixel);
  EXPECT_GT(corners[1].covariance(0, 0), 0.0) << "none is exact";
  EXPECT_GT(corners[0].covariance(0, 0), 0.01);
  EXPECT_LT(corners[0].covariance(0, 0), 0.011);
}

}  // namespace
}  // namespace thermovox::test
