// The covariance of shared errors against seeded draws of the same errors, each carried through the whole
// way: the laser's returns are placed anew, and the camera's ray meets the surface that they then make.
#include "mapping/shared_errors.hpp"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

#include "projection/error.hpp"

namespace thermovox {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr Time kStamp{std::chrono::seconds(1000)};
const Pose kT_world_body{expRotation({0.2, -0.1, 0.7}), {20.0, -5.0, 2.0}};
const Eigen::Matrix3d kCameraAxes = (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();
const Pose kT_body_laser{expRotation({0.05, 0.1, -0.02}), {0.1, 0.3, 0.2}};
const Pose kT_body_camera{Eigen::Quaterniond(kCameraAxes), {0.05, -0.4, -0.1}};
const Eigen::Vector3d kSpot_body(4.0, 0.3, -0.2);
const Eigen::Vector3d kNormal_body = Eigen::Vector3d(-1.0, 0.5, 0.3).normalized();

ThermalCamera camera() {
  Intrinsics in{.width_px = 160, .height_px = 120};
  in.parameters = {147.0, 147.0, 79.5, 59.5};
  return {.camera = Camera(in), .T_body_camera = kT_body_camera};
}

Mission standing(const Laser& laser) {
  return {
      .rig = {.thermal_camera = camera(), .lasers = {laser}},
      .trajectory = Trajectory({{kStamp, kT_world_body}, {kStamp + std::chrono::seconds(1), kT_world_body}})};
}

Laser laserWith(const Matrix6d& covariance, double range_bias_sigma = 0.0) {
  return {.T_body_laser = kT_body_laser,
          .range_bias_sigma = range_bias_sigma,
          .covariance_body_laser = covariance};
}

/// Three places of the surface around the spot, in the laser's frame.
std::vector<Eigen::Vector3d> triangle() {
  const Eigen::Vector3d along = kNormal_body.unitOrthogonal(), across = kNormal_body.cross(along);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 3; ++i) {
    const double a = 2.0 * M_PI * i / 3.0;
    const Eigen::Vector3d p_body = kSpot_body + 0.02 * (std::cos(a) * along + std::sin(a) * across);
    points.push_back(kT_body_laser.inverse() * p_body);
  }
  return points;
}

std::vector<SharedMotion> motionsOf(const Mission& mission) {
  SharedMotions motions(mission);
  std::vector<PlacedReturn> reading;
  for (const Eigen::Vector3d& p_laser : triangle()) {
    reading.push_back({.stamp = kStamp,
                       .p_world = kT_world_body * (kT_body_laser * p_laser),
                       .origin_world = kT_world_body * kT_body_laser.translation,
                       .range = p_laser.norm()});
  }
  motions.add(reading, 0);
  return motions.means();
}

/// One draw of all that a mission shares.
struct Draw {
  Vector6d laser = Vector6d::Zero();  ///< rotation, translation, along the body's axes
  double range = 0.0;
  Vector6d pose = Vector6d::Zero();
};

/// Where the map has the spot when the errors are these.
Eigen::Vector3d spotWith(const Draw& draw) {
  const Pose T_body_laser{expRotation(draw.laser.head<3>()) * kT_body_laser.rotation,
                          kT_body_laser.translation + draw.laser.tail<3>()};
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3d& p_laser : triangle()) {
    corners.push_back(T_body_laser * (p_laser + draw.range * p_laser.normalized()));
  }
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const Eigen::Vector3d eye = kT_body_camera.translation, d = kSpot_body - eye;
  const Eigen::Vector3d p_body = eye + d * normal.dot(corners[0] - eye) / normal.dot(d);
  const Pose T_world_body{expRotation(draw.pose.head<3>()) * kT_world_body.rotation,
                          kT_world_body.translation + draw.pose.tail<3>()};
  return T_world_body * p_body;
}

Matrix6d someCovariance(double rotation, double translation) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const Matrix6d root = Matrix6d::NullaryExpr([&] { return normal(random); });
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(rotation), Eigen::Vector3d::Constant(translation);
  return scale.asDiagonal() * Matrix6d(root * root.transpose() / 6.0) * scale.asDiagonal();
}

/// The covariance of 40 000 draws: entries are good to 1 % of its size. Errors of some mrad and mm leave the
/// second order far below that.
void expectSpread(const Matrix6d& of_laser, double range_bias, const PoseSigmas& pose) {
  const Mission mission = standing(laserWith(of_laser, range_bias));
  const Eigen::Vector3d p_world = kT_world_body * kSpot_body;
  const Eigen::Vector3d n_world = kT_world_body.rotation * kNormal_body;
  const Eigen::Matrix3d covariance =
      sharedCovariance(p_world, n_world, motionsOf(mission), mission.rig, pose);
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  const auto draw6 = [&] { return Vector6d(Vector6d::NullaryExpr([&] { return normal(random); })); };
  const Matrix6d root = of_laser.ldlt().transpositionsP().transpose() * Matrix6d(of_laser.ldlt().matrixL()) *
                        of_laser.ldlt().vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  Vector6d of_pose;
  of_pose << Eigen::Vector3d::Constant(pose.rotation), Eigen::Vector3d::Constant(pose.translation);
  constexpr int kDraws = 40'000;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Draw draw{root * draw6(), range_bias * normal(random), of_pose.cwiseProduct(draw6())};
    const Eigen::Vector3d off = spotWith(draw) - p_world;
    spread += off * off.transpose() / kDraws;
  }
  EXPECT_LT((covariance - spread).norm(), 0.03 * spread.norm()) << "said\n"
                                                                << covariance << "\nfound\n"
                                                                << spread;
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12);
}

TEST(SharedCovariance, OfExtrinsicsIsWhatDrawsOfThemScatterBy) {
  expectSpread(someCovariance(0.002, 0.004), 0.0, {});
}

TEST(SharedCovariance, OfARangeBiasIsWhatDrawsOfItScatterBy) {
  expectSpread(Matrix6d::Zero(), 0.01, {});
}

TEST(SharedCovariance, OfThePoseIsWhatDrawsOfItScatterBy) {
  expectSpread(Matrix6d::Zero(), 0.0, {.rotation = 0.003, .translation = 0.005});
}

TEST(SharedCovariance, OfAllTogetherIsWhatDrawsOfThemScatterBy) {
  expectSpread(someCovariance(0.002, 0.003), 0.005, {.rotation = 0.001, .translation = 0.004});
}

TEST(SharedCovariance, WithoutANormalIsThatOfTheReturns) {
  Matrix6d translation = Matrix6d::Zero();
  translation.bottomRightCorner<3, 3>() = 1e-6 * Eigen::Matrix3d::Identity();
  const Mission mission = standing(laserWith(translation));
  const Eigen::Matrix3d covariance = sharedCovariance(kT_world_body * kSpot_body, Eigen::Vector3d::Zero(),
                                                      motionsOf(mission), mission.rig, {});
  EXPECT_LT((covariance - 1e-6 * Eigen::Matrix3d::Identity()).norm(), 1e-11);  // floats
}

TEST(SharedCovariance, DoesNotCareWhichWayANormalPoints) {
  const Mission mission = standing(laserWith(someCovariance(0.002, 0.004), 0.01));
  const Eigen::Vector3d n_world = kT_world_body.rotation * kNormal_body;
  const auto of = [&](const Eigen::Vector3d& n) {
    return sharedCovariance(kT_world_body * kSpot_body, n, motionsOf(mission), mission.rig, {});
  };
  EXPECT_LT((of(n_world) - of(-n_world)).norm(), 1e-15);
}

TEST(SharedCovariance, IsThatOfTheNearestCubeAndFarFromAllThePosesOwn) {
  const Mission mission = standing(laserWith(someCovariance(0.0, 0.004)));  // the same everywhere
  const std::vector<SharedMotion> motions = motionsOf(mission);
  const Eigen::Vector3d p_world = kT_world_body * kSpot_body;
  const PoseSigmas pose{.translation = 0.01};
  const auto at = [&](const Eigen::Vector3d& p) {
    return sharedCovariance(p, Eigen::Vector3d::Zero(), motions, mission.rig, pose);
  };
  EXPECT_EQ(at(p_world + Eigen::Vector3d(2.0, 0.0, 0.0)), at(p_world));
  const Eigen::Matrix3d of_pose = 1e-4 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(at(p_world + Eigen::Vector3d(5.0, 0.0, 0.0)).isApprox(of_pose));
  EXPECT_TRUE(sharedCovariance(p_world, Eigen::Vector3d::Zero(), {}, mission.rig, pose).isApprox(of_pose));
  EXPECT_TRUE(at({1e9, -2e9, 1e9}).isApprox(of_pose));
}

/// A spot half a metre from the returns of its cube turns with its own lever, and is seen along its own ray.
TEST(SharedCovariance, IsThatOfTheSpotsOwnPlaceInTheCube) {
  const Mission mission = standing(laserWith(someCovariance(0.002, 0.004)));
  const Eigen::Vector3d n_world = kT_world_body.rotation * kNormal_body;
  const Eigen::Vector3d p_world =
      kT_world_body * (kSpot_body + 0.5 * kNormal_body.unitOrthogonal().normalized());
  const PoseSigmas pose{.rotation = 0.003};
  SharedMotions there(mission);
  there.add(
      std::vector<PlacedReturn>{
          {.stamp = kStamp, .p_world = p_world, .origin_world = kT_world_body * kT_body_laser.translation}},
      0);
  const Eigen::Matrix3d carried = sharedCovariance(p_world, n_world, motionsOf(mission), mission.rig, pose);
  const Eigen::Matrix3d own = sharedCovariance(p_world, n_world, there.means(), mission.rig, pose);
  EXPECT_LT((carried - own).norm(), 1e-5 * own.norm());  // floats
}

TEST(SharedMotions, OfSightsFromAllSidesMoveTheSpotLess) {
  // A spot that the beam hit once from the front and once from behind: a range bias moves the two apart, and
  // their mean not at all.
  const Eigen::Vector3d p_world(0.5, 0.5, 0.5);
  const Pose turned{expRotation({0, 0, M_PI}), {5.5, 0.5, 0.5}};
  Mission mission = standing({.range_bias_sigma = 0.02});
  mission.trajectory = Trajectory({{kStamp, {Eigen::Quaterniond::Identity(), {-4.5, 0.5, 0.5}}},
                                   {kStamp + std::chrono::milliseconds(400), turned}});
  SharedMotions motions(mission);
  motions.add(
      std::vector<PlacedReturn>{{.stamp = kStamp, .p_world = p_world, .origin_world = {-4.5, 0.5, 0.5}}}, 0);
  const Eigen::Matrix3d one =
      sharedCovariance(p_world, Eigen::Vector3d::Zero(), motions.means(), mission.rig, {});
  EXPECT_NEAR(one(0, 0), 4e-4, 1e-9);
  motions.add(std::vector<PlacedReturn>{{.stamp = kStamp + std::chrono::milliseconds(400),
                                         .p_world = p_world,
                                         .origin_world = turned.translation}},
              0);
  const std::vector<SharedMotion> both = motions.means();
  ASSERT_THAT(both, SizeIs(1));
  EXPECT_EQ(both[0].count, 2U);
  EXPECT_LT(sharedCovariance(p_world, Eigen::Vector3d::Zero(), both, mission.rig, {}).norm(), 1e-12);
}

TEST(SharedMotions, TakeShortReadingsWhollyAndOthersInPart) {
  const Mission mission = standing({});
  const auto countOf = [&](std::size_t returns, Time stamp) {
    SharedMotions motions(mission);
    motions.add(std::vector<PlacedReturn>(returns, {.stamp = stamp, .p_world = {1, 1, 1}}), 0);
    const auto means = motions.means();
    return means.empty() ? 0U : means[0].count;
  };
  EXPECT_EQ(countOf(64, kStamp), 64U);
  EXPECT_EQ(countOf(3200, kStamp), 100U);
  EXPECT_EQ(countOf(64, kStamp - std::chrono::seconds(9)), 0U);  // there is no pose for it
  EXPECT_EQ(countOf(0, kStamp), 0U);
}

TEST(MovedMotions, OfAMovedWorldGiveTheMovedCovariance) {
  const Mission mission = standing(laserWith(someCovariance(0.002, 0.004), 0.01));
  const std::vector<SharedMotion> motions = motionsOf(mission);
  const Pose T_new_old{expRotation({0.3, -0.2, 1.1}), {-7.0, 3.0, 12.0}};
  const Eigen::Vector3d p = kT_world_body * kSpot_body, n = kT_world_body.rotation * kNormal_body;
  const PoseSigmas pose{.rotation = 0.001, .translation = 0.002};
  const Eigen::Matrix3d R = T_new_old.matrix();
  const Eigen::Matrix3d expected = R * sharedCovariance(p, n, motions, mission.rig, pose) * R.transpose();
  const Eigen::Matrix3d there =
      sharedCovariance(T_new_old * p, R * n, moved(motions, T_new_old), mission.rig, pose);
  EXPECT_LT((there - expected).norm(), 1e-5 * expected.norm());  // floats
}

TEST(MovedMotions, ThatMeetAreAveraged) {
  SharedMotion a, b;
  a.cube = {0, 0, 0};
  b.cube = {1, 0, 0};
  a.count = 1;
  b.count = 3;
  a.by_range = {1.0F, 0.0F, 0.0F};
  b.by_range = {-1.0F, 0.0F, 0.0F};
  // Turned by 45 degrees and shifted, the centres of both lie in one cube.
  const Pose turned{expRotation({0, 0, M_PI / 4}), {0.1, -0.7, 0.0}};
  const auto both = moved(std::vector<SharedMotion>{a, b}, turned);
  ASSERT_THAT(both, SizeIs(1));
  EXPECT_EQ(both[0].count, 4U);
  const Eigen::Vector3f mean = turned.matrix().cast<float>() * Eigen::Vector3f(-0.5F, 0.0F, 0.0F);
  EXPECT_LT((both[0].by_range - mean).norm(), 1e-6F);
  EXPECT_THAT(moved({}, turned), IsEmpty());
}

TEST(MovedMotions, OutOfTheWorldAreRefused) {
  const std::vector<SharedMotion> one{SharedMotion{.count = 1}};
  EXPECT_THROW((void)moved(one, {Eigen::Quaterniond::Identity(), {1e12, 0.0, 0.0}}), DataError);
}

}  // namespace
}  // namespace thermovox
