#include "mapping/intrinsics_error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace thermovox {
namespace {

/// A camera 3 m before a wall, turned against it, with what it is not sure of; one frame that saw a spot
/// there.
class IntrinsicsError : public testing::Test {
 protected:
  IntrinsicsError() {
    Eigen::Matrix<double, 9, 1> sigmas;
    sigmas << 0.8, 0.8, 1.2, 1.0, 0.01, 0.005, 1e-4, 1e-4, 1e-4;
    camera.covariance_intrinsics = sigmas.cwiseAbs2().asDiagonal();
    camera.covariance_intrinsics(0, 1) = camera.covariance_intrinsics(1, 0) = 0.6;
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
    frames.push_back({Time(std::chrono::seconds(1)), {turned, Eigen::Vector3d(0.3, 0.1, -3.0)}});
    spot.position.p_world = {1.6, 0.5, 0.0};
    spot.normal = -Eigen::Vector3d::UnitZ();
    spot.best_frame = SeenInFrame{frames[0].stamp, Eigen::Vector2d::Zero()};
  }
  static Intrinsics lens() {
    Intrinsics intrinsics{.width_px = 160, .height_px = 120, .model = LensModel::brown_conrady};
    intrinsics.parameters = {152.0, 150.0, 80.0, 60.0, -0.2, 0.05, 1e-3, -1e-3, 0.0};
    intrinsics.distortion_count = 5;
    return intrinsics;
  }

  ThermalCamera camera{.camera = Camera(lens())};
  std::vector<FramePose> frames;
  Hotspot spot;
};

TEST_F(IntrinsicsError, IsTheScatterOfWhereWrongIntrinsicsPutTheSpot) {
  const Eigen::MatrixXd root = camera.covariance_intrinsics.llt().matrixL();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Pose& T_world_camera = frames[0].T_world_camera;
  const Eigen::Vector3d p_camera = T_world_camera.inverse() * spot.position.p_world;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  constexpr int kRuns = 20000;
  for (int run = 0; run < kRuns; ++run) {
    Eigen::VectorXd drawn(9);
    for (double& one : drawn) one = normal(random);
    drawn = root * drawn;
    Intrinsics real = lens();
    for (std::size_t i = 0; i < 9; ++i) real.parameters[i] += drawn[static_cast<Eigen::Index>(i)];
    // The real camera sees the spot in a pixel; the ray that we think this is meets the wall elsewhere.
    const Eigen::Vector2d pixel = *Camera(real).projectUnbounded(p_camera);
    const Eigen::Vector3d ray = T_world_camera.matrix() * *camera.camera.rayFromPixel(pixel);
    const Eigen::Vector3d from = T_world_camera.translation;
    const Eigen::Vector3d off = from - from.z() / ray.z() * ray - spot.position.p_world;
    scatter += off * off.transpose() / kRuns;
  }
  const Eigen::Matrix3d covariance = intrinsicsCovariance(spot, frames, camera);
  EXPECT_GT(covariance.trace(), 1e-4);
  EXPECT_LT((covariance - scatter).norm(), 0.05 * scatter.norm());
}

TEST_F(IntrinsicsError, IsZeroWhereNothingIsDeclaredOrNoFrameIsKnown) {
  EXPECT_TRUE(intrinsicsCovariance(spot, {}, camera).isZero());
  const ThermalCamera certain{.camera = Camera(lens())};
  EXPECT_TRUE(intrinsicsCovariance(spot, frames, certain).isZero());
}

TEST_F(IntrinsicsError, WithoutABestFrameIsThatOfTheFrameThatWouldMoveItMost) {
  const double known = intrinsicsCovariance(spot, frames, camera).trace();
  spot.best_frame.reset();
  EXPECT_GE(intrinsicsCovariance(spot, frames, camera).trace(), known);
  for (FramePose& frame : frames) frame.T_world_camera.translation += Eigen::Vector3d(1e3, 0.0, 0.0);
  EXPECT_TRUE(intrinsicsCovariance(spot, frames, camera).isZero()) << "none had it in its picture";
}

TEST_F(IntrinsicsError, OfAnUnknownNormalIsAcrossTheView) {
  spot.normal.setZero();
  const Eigen::Matrix3d covariance = intrinsicsCovariance(spot, frames, camera);
  const Eigen::Vector3d ray = (spot.position.p_world - frames[0].T_world_camera.translation).normalized();
  EXPECT_GT(covariance.trace(), 1e-5);
  EXPECT_LT((covariance * ray).norm(), 1e-9);
}

}  // namespace
}  // namespace thermovox
