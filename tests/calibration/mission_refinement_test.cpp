#include "calibration/mission_refinement.hpp"

#include <gtest/gtest.h>

#include "projection/error.hpp"
#include "tests/calibration/panel_scene.hpp"

namespace thermovox::test {
namespace {

constexpr double kDegree = 0.017453292519943295;

Eigen::Vector3d turnBetween(const Pose& a, const Pose& b) {
  const Eigen::AngleAxisd turn(a.rotation * b.rotation.conjugate());
  return turn.angle() * turn.axis();
}

Laser cloudLaser() {
  Laser laser;
  laser.kind = LaserKind::cloud;
  return laser;
}

/// A rig that says that its laser is elsewhere.
EdgeScene moved(EdgeScene scene, const Eigen::Vector3d& w, const Eigen::Vector3d& v) {
  EdgeChange change = EdgeChange::Zero();
  change << w, v, 0.0;
  scene.T_body_laser = changedPose(scene.T_body_laser, change);
  return scene;
}

/// How far a laser at another place puts its edges from where they are, rms, px.
double pixelError(const EdgeScene& truth, const Pose& T_body_laser) {
  EdgeScene other = truth;
  other.T_body_laser = T_body_laser;
  double squares = 0.0;
  int count = 0;
  for (const EdgeFrame& frame : truth.frames) {
    for (const PlacedEdge& edge : frame.edges) {
      const auto right = predictedEdge(truth, frame, edge, EdgeChange::Zero());
      const auto found = predictedEdge(other, frame, edge, EdgeChange::Zero());
      if (right && found) squares += (right->pixel - found->pixel).squaredNorm(), ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(PredictedEdge, DerivativesAgreeWithDifferences) {
  const PanelWorld world;
  const EdgeScene scene = world.scene(8);
  EdgeChange change;
  change << 0.01, -0.02, 0.005, 0.01, 0.02, -0.01, 0.013;
  int compared = 0;
  for (std::size_t i = 0; i < scene.frames[5].edges.size(); i += 7) {
    const auto predict = [&](const EdgeChange& at) {
      return predictedEdge(scene, scene.frames[5], scene.frames[5].edges[i], at);
    };
    const auto predicted = predict(change);
    if (!predicted) continue;
    for (int k = 0; k < 7; ++k) {
      // Of the stamp no less: between two poses the trajectory is interpolated, so the derivative has steps.
      const double step = k == 6 ? 0.004 : 1e-5;
      EdgeChange more = change, less = change;
      if (k < 3) {  // about the body's axes after the rotation so far
        const auto turned = [&](double by) {
          const Eigen::AngleAxisd turn(expRotation(by * Eigen::Vector3d::Unit(k)) *
                                       expRotation(change.head<3>()));
          return Eigen::Vector3d(turn.angle() * turn.axis());
        };
        more.head<3>() = turned(step), less.head<3>() = turned(-step);
      } else {
        more[k] += step, less[k] -= step;
      }
      const auto above = predict(more), below = predict(less);
      if (!above || !below) continue;
      const Eigen::Vector2d slope = (above->pixel - below->pixel) / (2.0 * step);
      EXPECT_NEAR((predicted->jacobian.col(k) - slope).norm(), 0.0, 1e-3 * (1.0 + slope.norm())) << k;
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(MissionRefinement, ATrueRigStaysAsItIs) {
  PanelWorld world;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    world.seed = seed;
    const MissionRefinement found = refineOnMission(world.scene(), cloudLaser());
    EXPECT_FALSE(found.refined);
    EXPECT_TRUE(found.consistent);
    EXPECT_TRUE(found.applied.isZero());
    EXPECT_EQ(found.T_body_laser, world.T_body_laser);
    EXPECT_LT(found.rms_px, 0.5);
    EXPECT_EQ(found.frames, 30);
    for (int i = 0; i < 7; ++i) EXPECT_LT(std::abs(found.change[i]), 3.0 * found.sigma[i]) << i;
  }
}

TEST(MissionRefinement, FindsWhereTheLaserReallyIs) {
  const PanelWorld world;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto direction = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
  };
  const EdgeScene truth = world.scene();
  for (int trial = 0; trial < 4; ++trial) {
    SCOPED_TRACE(trial);
    const EdgeScene scene = moved(truth, kDegree * direction(), 0.02 * direction());
    const MissionRefinement found = refineOnMission(scene, cloudLaser());
    EXPECT_TRUE(found.refined);
    EXPECT_FALSE(found.consistent);
    EXPECT_LT(found.rms_px_refined, found.rms_px);
    EXPECT_LT(turnBetween(found.T_body_laser, world.T_body_laser).norm(), 0.5 * kDegree);
    // What counts: where points come to lie in the image.
    EXPECT_LT(pixelError(truth, found.T_body_laser), 0.3);
    EXPECT_LT(pixelError(truth, found.T_body_laser), 0.3 * pixelError(truth, scene.T_body_laser));
  }
}

TEST(MissionRefinement, ASmallErrorIsNeverMadeALargerOne) {
  const PanelWorld world;
  const EdgeScene truth = world.scene();
  for (const double size : {0.1, 0.2, 0.4}) {
    for (const double sign : {-1.0, 1.0}) {
      SCOPED_TRACE(sign * size);
      const Eigen::Vector3d turn = sign * size * kDegree * Eigen::Vector3d(0.5, 0.6, -0.6);
      const EdgeScene scene = moved(truth, turn, sign * size * Eigen::Vector3d(0.01, -0.01, 0.02));
      const MissionRefinement found = refineOnMission(scene, cloudLaser());
      EXPECT_LE(pixelError(truth, found.T_body_laser), pixelError(truth, scene.T_body_laser));
    }
  }
}

TEST(MissionRefinement, FindsLateStampsAndLeavesTheRigAlone) {
  const PanelWorld world;
  const MissionRefinement found = refineOnMission(world.scene(30, 0.08), cloudLaser());
  EXPECT_FALSE(found.refined);
  EXPECT_FALSE(found.consistent);
  EXPECT_EQ(found.T_body_laser, world.T_body_laser);
  EXPECT_NEAR(found.applied[6], -0.08, 3.0 * found.sigma[6]);
  EXPECT_LT(found.sigma[6], 0.01);
}

TEST(MissionRefinement, ImagesOfSomethingElseChangeNothing) {
  const PanelWorld world;
  EdgeScene scene = world.scene();
  PanelWorld other;  // whose panels are elsewhere
  for (Panel& panel : other.panels) {
    panel.y = -0.8 * panel.y + 0.3;
    panel.z = 0.7 * panel.z - 0.4;
    std::swap(panel.half_y, panel.half_z);
  }
  const EdgeScene unrelated = other.scene();
  for (std::size_t i = 0; i < scene.frames.size(); ++i) scene.frames[i].thermal = unrelated.frames[i].thermal;
  const MissionRefinement found = refineOnMission(scene, cloudLaser());
  EXPECT_FALSE(found.refined);
  EXPECT_FALSE(found.consistent) << "lock " << found.lock;
  EXPECT_EQ(found.T_body_laser, world.T_body_laser);
  EXPECT_FALSE(found.warnings.empty());
}

TEST(MissionRefinement, AGoodCovarianceIsKeptTo) {
  const PanelWorld world;
  Laser laser = cloudLaser();
  laser.covariance_body_laser.diagonal() << 1e-8, 1e-8, 1e-8, 1e-8, 1e-8, 1e-8;
  const MissionRefinement found = refineOnMission(world.scene(), laser);
  EXPECT_FALSE(found.refined);
  for (int i = 0; i < 6; ++i) EXPECT_LT(found.sigma[i], 1.01e-4) << i;
  EXPECT_EQ(found.undetermined.size(), 6U) << "the mission adds nothing to what is known";
}

TEST(MissionRefinement, ABeamsRollIsHeld) {
  const PanelWorld world;
  Laser laser;
  laser.kind = LaserKind::beam;
  laser.T_body_laser = world.T_body_laser;
  const MissionRefinement found = refineOnMission(world.scene(), laser);
  const Eigen::Vector3d axis = world.T_body_laser.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(axis.dot(found.change.head<3>()), 0.0, 1e-4);
  EXPECT_NEAR(axis.dot(found.covariance_body_laser.topLeftCorner<3, 3>() * axis), 0.0, 1e-12);
}

TEST(MissionRefinement, TooFewEdgesAreRefused) {
  const PanelWorld world;
  EXPECT_THROW(static_cast<void>(refineOnMission(world.scene(3), cloudLaser())), UnobservableError);
  EdgeScene scene = world.scene(10);
  for (EdgeFrame& frame : scene.frames) frame.edges.resize(2);
  try {
    static_cast<void>(refineOnMission(scene, cloudLaser()));
    FAIL() << "expected UnobservableError";
  } catch (const UnobservableError& error) {
    EXPECT_NE(std::string(error.what()).find("no temperature edges at depth edges"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace thermovox::test
