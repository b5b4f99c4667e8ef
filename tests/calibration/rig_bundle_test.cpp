#include "calibration/rig_bundle.hpp"

#include <gtest/gtest.h>

#include <map>

#include "tests/calibration/calibration_scene.hpp"
#include "tests/calibration/moved_estimate.hpp"
#include "tests/projection/matchers.hpp"

namespace thermovox::test {
namespace {

constexpr std::array<LaserKind, 3> kKinds{LaserKind::beam, LaserKind::scan, LaserKind::cloud};

BundleScene sceneOf(LaserKind kind) {
  return made({.kind = kind,
               .captures = 14,
               .cameras = 2,
               .seed = 5,
               .edges = kind == LaserKind::cloud ? BundleScene::Edges::exact : BundleScene::Edges::none});
}

/// Some way from the truth, as a start is.
RigEstimate disturbed(const BundleScene& scene) {
  Chance chance(6);
  RigEstimate start = scene.truth;
  for (Intrinsics& lens : start.cameras) {
    lens.parameters[kFx] += 4.0;
    lens.parameters[kCy] -= 2.0;
    lens.parameters[kDistortion] += 0.05;
  }
  start.T_camera_reference[1] = moved(start.T_camera_reference[1], chance, 0.02, 0.02);
  for (Pose& board : start.T_reference_board) board = moved(board, chance, 0.03, 0.02);
  if (scene.kind == LaserKind::beam) {
    start.T_reference_laser.rotation = start.T_reference_laser.rotation * expRotation({0.0, 0.05, -0.04});
    start.T_reference_laser.translation += Eigen::Vector3d(0.03, -0.02, 0.02);
  } else {
    start.T_reference_laser = moved(start.T_reference_laser, chance, 0.05, 0.03);
  }
  return start;
}

double apart(const Pose& a, const Pose& b) {
  return std::max(a.rotation.angularDistance(b.rotation), (a.translation - b.translation).norm());
}

TEST(SolveBundle, RecoversTheTruthWithoutNoise) {
  for (const LaserKind kind : kKinds) {
    SCOPED_TRACE(testing::Message() << dimensionsOf(kind) << "D");
    const BundleScene scene = sceneOf(kind);
    const BundleFit fit = solveBundle(scene.data, disturbed(scene), scene.model);
    EXPECT_TRUE(fit.converged);
    EXPECT_LT(fit.cost, 1e-9);
    // The steps end at a change of the cost of 1e-10 of itself, where Gauss and Newton converge
    // quadratically.
    const Pose &found = fit.estimate.T_reference_laser, &truth = scene.truth.T_reference_laser;
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    EXPECT_THAT(found.rotation * x, IsNear(truth.rotation * x, 1e-6));
    EXPECT_LT(found.rotation.angularDistance(truth.rotation), kind == LaserKind::beam ? 0.1 : 1e-6);
    EXPECT_THAT(found.translation, IsNear(truth.translation, 1e-6));
    EXPECT_LT(apart(fit.estimate.T_camera_reference[1], scene.truth.T_camera_reference[1]), 1e-6);
    for (std::size_t i = 0; i < scene.captures; ++i)
      EXPECT_LT(apart(fit.estimate.T_reference_board[i], scene.truth.T_reference_board[i]), 1e-6);
    for (std::size_t camera = 0; camera < 2; ++camera) {
      for (std::size_t i = 0; i < kCameraParameters; ++i)  // px: a focal length of 150
        EXPECT_NEAR(fit.estimate.cameras[camera].parameters[i], scene.truth.cameras[camera].parameters[i],
                    1e-4);
    }
  }
}

TEST(SolveBundle, KeepsTheRollOfABeam) {
  const BundleScene scene = sceneOf(LaserKind::beam);
  RigEstimate start = scene.truth;
  start.T_reference_laser.rotation = start.T_reference_laser.rotation * expRotation({1.2, 0.0, 0.0});
  const BundleFit fit = solveBundle(scene.data, start, scene.model);
  EXPECT_LT(apart(fit.estimate.T_reference_laser, start.T_reference_laser), 1e-7);
}

TEST(SolveBundle, DoesNotMoveWhatIsHeld) {
  BundleScene scene = sceneOf(LaserKind::cloud);
  scene.model.free_intrinsics = {{kFx, kFy}, {}};
  const RigEstimate start = disturbed(scene);
  const BundleFit fit = solveBundle(scene.data, start, scene.model);
  EXPECT_EQ(fit.estimate.cameras[1].parameters, start.cameras[1].parameters);
  for (std::size_t i = 0; i < kCameraParameters; ++i) {
    const bool moved = fit.estimate.cameras[0].parameters[i] != start.cameras[0].parameters[i];
    EXPECT_EQ(moved, i == kFx || i == kFy) << i;
  }
  EXPECT_EQ(fit.estimate.T_camera_reference[0], Pose{});
  EXPECT_EQ(fit.estimate.common_range_bias, 0.0);
}

TEST(SolveBundle, LeavesALaserThatNothingIsKnownOf) {
  BundleScene scene = sceneOf(LaserKind::cloud);
  for (CaptureObservations& capture : scene.data.captures) capture.plane.reset();
  const RigEstimate start = disturbed(scene);
  const BundleFit fit = solveBundle(scene.data, start, scene.model);
  EXPECT_EQ(fit.estimate.T_reference_laser, start.T_reference_laser);
  EXPECT_EQ(linearise(scene.data, start, scene.model).layout.laser_size, 0);
}

TEST(SolveBundle, SharesABiasOfAllRanges) {
  BundleScene scene = made({.kind = LaserKind::cloud, .captures = 14, .seed = 7});
  for (std::size_t i = 0; i < scene.captures; ++i) {
    ReturnSet returns;
    for (const Eigen::Vector3d& ray : raysOf(LaserKind::cloud)) {
      if (const auto range = rangeOfPlate(ray, scene.laserFromBoard(i), scene.board))
        returns.emplace_back((*range + 0.02) * ray);
    }
    scene.data.captures[i].plane = planeMoments(returns, LaserKind::cloud, 0.001);
  }
  scene.model.common_range_bias_sigma = 0.05;
  scene.model.range_bias_sigma = 0.0005;
  const BundleFit fit = solveBundle(scene.data, scene.truth, scene.model);
  EXPECT_NEAR(fit.estimate.common_range_bias, -0.02, 0.0005);
  EXPECT_LT(apart(fit.estimate.T_reference_laser, scene.truth.T_reference_laser), 1e-3);
}

TEST(SolveBundle, IsNotPulledByOneCornerWithHubersLoss) {
  BundleScene scene = made({.captures = 6, .corner_sigma_px = 0.05, .seed = 8});
  for (CaptureObservations& capture : scene.data.captures) capture.plane.reset();
  const BundleFit clean = solveBundle(scene.data, scene.truth, scene.model);
  scene.data.captures[2].corners[7].pixel += Eigen::Vector2d(6.0, 4.0);
  const BundleFit pulled = solveBundle(scene.data, scene.truth, scene.model);
  scene.model.corner_loss = BundleModel::Loss::huber;
  const BundleFit robust = solveBundle(scene.data, scene.truth, scene.model);
  const auto off = [&](const BundleFit& fit) {
    return apart(fit.estimate.T_reference_board[2], clean.estimate.T_reference_board[2]);
  };
  EXPECT_LT(off(robust), 0.2 * off(pulled));
}

BundleScene noisyScene(LaserKind kind) {
  BundleScene scene = made({.kind = kind,
                            .captures = 4,
                            .cameras = 2,
                            .corner_sigma_px = 0.1,
                            .range_sigma = 0.005,
                            .seed = 9,
                            .edges = BundleScene::Edges::exact});
  scene.model.common_range_bias_sigma = 0.01;
  scene.model.edge_factor = 1.3;
  scene.model.plane_factor = 1.2;
  scene.model.edge_offset_sigma = 0.004;
  return scene;
}

TEST(Linearise, HasTheJacobianOfFiniteDifferences) {
  for (const LaserKind kind : kKinds) {
    const BundleScene scene = noisyScene(kind);
    RigEstimate at = disturbed(scene);
    at.common_range_bias = 0.003;
    const Linearisation linear = linearise(scene.data, at, scene.model);
    const Eigen::MatrixXd jacobian = linear.jacobian;
    ASSERT_EQ(jacobian.cols(), linear.layout.size);
    const double step = 1e-6;
    for (int i = 0; i < linear.layout.size; ++i) {
      const Eigen::VectorXd along = step * Eigen::VectorXd::Unit(linear.layout.size, i);
      const Eigen::VectorXd ahead =
          linearise(scene.data, movedBy(at, linear.layout, along, scene.model), scene.model).residuals;
      const Eigen::VectorXd behind =
          linearise(scene.data, movedBy(at, linear.layout, -along, scene.model), scene.model).residuals;
      const Eigen::VectorXd column = (ahead - behind) / (2.0 * step);
      // Residuals of up to 1e3 sigmas with 1e-13 of themselves of rounding: 1e-4 over the step, of columns of
      // 1e3 and more; what the step's third derivative adds is far less.
      EXPECT_LT((jacobian.col(i) - column).norm(), 1e-6 * column.norm() + 1e-3) << "unknown " << i;
    }
  }
}

TEST(Linearise, GroupsAllRowsOnce) {
  for (const LaserKind kind : kKinds) {
    const BundleScene scene = noisyScene(kind);
    const Linearisation linear = linearise(scene.data, scene.truth, scene.model);
    int rows = 0;
    std::map<RowGroup::Kind, int> counts;
    for (const RowGroup& group : linear.groups) {
      EXPECT_EQ(group.first, rows) << "one after the other";
      rows += group.count;
      counts[group.kind] += group.count;
    }
    EXPECT_EQ(rows, linear.jacobian.rows());
    EXPECT_EQ(rows, linear.residuals.size());
    EXPECT_EQ(counts[RowGroup::Kind::corners], 4 * 2 * 40 * 2);
    EXPECT_EQ(counts[RowGroup::Kind::plane], 4 * 5) << "with the bias of the capture";
    EXPECT_EQ(counts[RowGroup::Kind::edges], 4 * 4 * 3);
    EXPECT_EQ(counts[RowGroup::Kind::prior], 2);
  }
}

TEST(Linearise, HasItsResidualsInSigmas) {
  const BundleScene scene = noisyScene(LaserKind::cloud);
  BundleModel twice = scene.model;
  for (double& factor : twice.corner_factor) factor *= 2.0;
  twice.plane_factor *= 2.0;
  const Linearisation one = linearise(scene.data, scene.truth, scene.model),
                      two = linearise(scene.data, scene.truth, twice);
  for (const RowGroup& group : one.groups) {
    if (group.kind == RowGroup::Kind::edges || group.kind == RowGroup::Kind::prior) continue;
    const int rows = group.kind == RowGroup::Kind::plane ? 4 : group.count;  // not the bias's prior
    EXPECT_THAT(two.residuals.segment(group.first, rows),
                IsNear(0.5 * one.residuals.segment(group.first, rows), 1e-9));
  }
}

TEST(Linearise, HasNoUnknownsOfWhatNobodySaw) {
  BundleScene scene = noisyScene(LaserKind::scan);
  scene.data.captures[1] = {};
  for (CaptureObservations& capture : scene.data.captures)
    std::erase_if(capture.corners, [](const auto& corner) { return corner.camera == 1; });
  const TangentLayout layout = linearise(scene.data, scene.truth, scene.model).layout;
  EXPECT_EQ(layout.board[1], -1);
  EXPECT_EQ(layout.range_bias[1], -1);
  EXPECT_EQ(layout.intrinsics[1], -1);
  EXPECT_EQ(layout.camera_pose, (std::vector<int>{-1, -1}));
  EXPECT_EQ(layout.size, 6 + 6 + 2 + 3 * (1 + 6));
}

}  // namespace
}  // namespace thermovox::test
