#include "calibration/reprojection_residual.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/calibration/gradients.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

std::vector<double> lensBlock(const Intrinsics& lens) {
  return {lens.parameters.begin(), lens.parameters.end()};
}

/// OpenCV's pixel of a point of the board.
Eigen::Vector2d seenByOpenCv(const Intrinsics& lens, const Pose& T_camera_board, const Eigen::Vector3d& p) {
  const Eigen::AngleAxisd turn(T_camera_board.rotation);
  const Eigen::Vector3d w = turn.angle() * turn.axis(), &t = T_camera_board.translation;
  const auto& k = lens.parameters;
  const cv::Matx33d K(k[kFx], 0, k[kCx], 0, k[kFy], k[kCy], 0, 0, 1);
  const std::vector<cv::Point3d> point{{p.x(), p.y(), p.z()}};
  std::vector<cv::Point2d> pixel;
  if (lens.model == LensModel::kannala_brandt) {
    cv::fisheye::projectPoints(point, pixel, cv::Vec3d(w.x(), w.y(), w.z()), cv::Vec3d(t.x(), t.y(), t.z()),
                               K, cv::Vec4d(k[4], k[5], k[6], k[7]));
  } else {
    const std::vector<double> d(k.begin() + kDistortion, k.end());
    cv::projectPoints(point, cv::Vec3d(w.x(), w.y(), w.z()), cv::Vec3d(t.x(), t.y(), t.z()), K, d, pixel);
  }
  return {pixel.front().x, pixel.front().y};
}

TEST(ReprojectionResidual, IsWhatOpenCvSeesLessWhatWasObserved) {
  Chance chance(1);
  for (const LensModel model : {LensModel::pinhole, LensModel::brown_conrady, LensModel::kannala_brandt}) {
    const Intrinsics lens = lensOf(model);
    for (const Pose& board : boardsHeld(20, 1)) {
      const Eigen::Vector3d p(chance.uniform(-0.2, 0.2), chance.uniform(-0.15, 0.15), 0.0);
      const Eigen::Vector2d pixel(chance.uniform(0.0, 159.0), chance.uniform(0.0, 119.0));
      const ReprojectionResidual residual{model, p, pixel, Eigen::Matrix2d::Identity()};
      Eigen::Vector2d r(0.0, 0.0);
      ASSERT_TRUE(residual(blockOf(board).data(), lensBlock(lens).data(), r.data()));
      EXPECT_THAT(r, IsNear(seenByOpenCv(lens, board, p) - pixel, 1e-9));  // OpenCV's own rounding is 1e-12
    }
  }
}

TEST(ReprojectionResidual, SeesTheBoardThroughTheReferenceCamera) {
  const Intrinsics lens = lensOf(LensModel::brown_conrady);
  const Pose board = boardsHeld(1, 2).front(), camera{expRotation({0.02, -0.05, 0.01}), {0.09, 0.0, 0.01}};
  const ReprojectionResidual residual{
      lens.model, {0.1, -0.05, 0.0}, {80.0, 60.0}, Eigen::Matrix2d::Identity()};
  Eigen::Vector2d through(0.0, 0.0), direct(0.0, 0.0);
  ASSERT_TRUE(
      residual(blockOf(board).data(), lensBlock(lens).data(), blockOf(camera).data(), through.data()));
  ASSERT_TRUE(residual(blockOf(camera * board).data(), lensBlock(lens).data(), direct.data()));
  EXPECT_THAT(through, IsNear(direct, 1e-11));
}

TEST(ReprojectionResidual, IsInSigmas) {
  Eigen::Matrix2d covariance;
  covariance << 0.09, 0.03, 0.03, 0.04;
  const Eigen::Matrix2d whitening = Eigen::LLT<Eigen::Matrix2d>(covariance.inverse()).matrixU();
  const Intrinsics lens = lensOf(LensModel::pinhole);
  const Pose board = boardsHeld(1, 3).front();
  const Eigen::Vector3d p(0.1, 0.1, 0.0);
  const Eigen::Vector2d off(0.7, -0.4), seen = seenByOpenCv(lens, board, p);
  const ReprojectionResidual residual{lens.model, p, seen + off, whitening};
  Eigen::Vector2d r(0.0, 0.0);
  ASSERT_TRUE(residual(blockOf(board).data(), lensBlock(lens).data(), r.data()));
  EXPECT_NEAR(r.squaredNorm(), off.dot(covariance.inverse() * off), 1e-9);
}

TEST(ReprojectionResidual, RefusesAPointBehindTheCamera) {
  const Intrinsics lens = lensOf(LensModel::pinhole);
  const ReprojectionResidual residual{lens.model, {0.0, 0.0, 0.0}, {80, 60}, Eigen::Matrix2d::Identity()};
  Eigen::Vector2d r(0.0, 0.0);
  EXPECT_FALSE(residual(blockOf({Eigen::Quaterniond::Identity(), {0.0, 0.0, -1.0}}).data(),
                        lensBlock(lens).data(), r.data()));
  EXPECT_FALSE(residual(blockOf({Eigen::Quaterniond::Identity(), {0.0, 0.0, std::nan("")}}).data(),
                        lensBlock(lens).data(), r.data()));
}

TEST(ReprojectionResidual, HasItsGradient) {
  const PoseManifold manifold;
  const Pose camera{expRotation({0.02, -0.05, 0.01}), {0.09, 0.0, 0.01}};
  for (const LensModel model : {LensModel::pinhole, LensModel::brown_conrady, LensModel::kannala_brandt}) {
    const Intrinsics lens = lensOf(model);
    for (const Pose& board : boardsHeld(5, 4)) {
      const ReprojectionResidual functor{
          model, {0.1, -0.08, 0.0}, {80.0, 60.0}, 5.0 * Eigen::Matrix2d::Identity()};
      const ceres::AutoDiffCostFunction<ReprojectionResidual, 2, 7, kCameraParameters> reference(
          new ReprojectionResidual(functor));
      EXPECT_TRUE(hasItsGradient(reference, {blockOf(board), lensBlock(lens)}, {&manifold, nullptr}));
      const ceres::AutoDiffCostFunction<ReprojectionResidual, 2, 7, kCameraParameters, 7> other(
          new ReprojectionResidual(functor));
      EXPECT_TRUE(hasItsGradient(other, {blockOf(board), lensBlock(lens), blockOf(camera)},
                                 {&manifold, nullptr, &manifold}));
    }
  }
}

}  // namespace
}  // namespace thermovox::test
