#include <Eigen/Dense>
#include <string>

#include "io/rig_file.hpp"
#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kDegree = M_PI / 180.0;

/// Captures of a simulated board beside their truth.
fs::path simulated(const TestFolder& folder, const std::string& options) {
  const Outcome outcome = thermovox(folder.path(), "simulate board " + options);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return folder / "board";
}

/// (w, v) that take the true pose to the found one, along the body's axes.
Vector6d errorOf(const Pose& found, const Pose& truth) {
  const Eigen::AngleAxisd turn(found.rotation * truth.rotation.conjugate());
  Vector6d error;
  error << turn.angle() * turn.axis(), found.translation - truth.translation;
  return error;
}

TEST(CalibrateVerb, FindsTheLaserWithinItsErrorBarAndNamesWhatMoved) {
  const TestFolder folder;
  simulated(folder, "--laser cloud --captures 10 --spoiled 1 --seed 3");
  const Outcome outcome = thermovox(folder.path(), "calibrate laser board -o rig.yaml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json result = outcome.json();
  EXPECT_TRUE(result.at("observable").get<bool>());
  EXPECT_EQ(result.at("captures_used"), 9);
  const json truth = json::parse(bytesOf(folder / "board.truth.json"));
  ASSERT_EQ(result.at("captures_dropped").size(), 1U);
  const std::string dropped = result.at("captures_dropped")[0].at("capture");
  EXPECT_TRUE(truth.at(std::stoul(dropped.substr(0, 3))).at("bad").get<bool>()) << dropped;
  for (const char* key : {"T_body_laser", "rotation_sigma_deg", "translation_sigma_mm", "rms_px", "rms_mm",
                          "weakest_direction", "warnings"})
    EXPECT_TRUE(result.contains(key)) << key;
  const Rig rig = readRig(folder / "rig.yaml"), exact = readRig(folder / "board.truth_rig.yaml");
  const Vector6d error = errorOf(rig.lasers[0].T_body_laser, exact.lasers[0].T_body_laser);
  const double squares = error.dot(rig.lasers[0].covariance_body_laser.ldlt().solve(error));
  EXPECT_LT(squares, 22.5) << error.transpose();  // six degrees of freedom: 1 in 1000
  EXPECT_LT(error.head<3>().norm(), 0.3 * kDegree);
  EXPECT_LT(error.tail<3>().norm(), 0.005);
  EXPECT_EQ(rig.thermal_camera->T_body_camera, exact.thermal_camera->T_body_camera);
  EXPECT_GT(rig.thermal_camera->covariance_intrinsics.size(), 0);
  EXPECT_NEAR(rig.thermal_camera->camera.fx(), exact.thermal_camera->camera.fx(), 0.5);
  EXPECT_FALSE(rig.visible_camera->covariance_body_camera.isZero(0.0));
}

TEST(CalibrateVerb, LeavesABeamsRollAsItWas) {
  const TestFolder folder;
  simulated(folder, "--laser beam --captures 12 --seed 2");
  const Outcome outcome = thermovox(folder.path(), "calibrate laser board -o rig.yaml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_FALSE(outcome.json().at("roll_observable").get<bool>());
  const Laser laser = readRig(folder / "rig.yaml").lasers[0];
  const Eigen::JacobiSVD<Matrix6d> svd(laser.covariance_body_laser);
  EXPECT_LT(svd.singularValues()[5], 1e-9 * svd.singularValues()[0]);
  EXPECT_GT(svd.singularValues()[4], 1e-9 * svd.singularValues()[0]);
}

TEST(CalibrateVerb, RefusesThreeCapturesOfAScannerWithThreeAndWritesNothing) {
  const TestFolder folder;
  simulated(folder, "--laser scan --captures 3");
  const Outcome outcome = thermovox(folder.path(), "calibrate laser board -o rig.yaml --json");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_FALSE(outcome.json().at("observable").get<bool>());
  EXPECT_THAT(outcome.json().at("reason").get<std::string>(), testing::HasSubstr("3 captures"));
  EXPECT_THAT(outcome.err, testing::HasSubstr("3 captures"));
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

TEST(CalibrateVerb, CalibratesCamerasAloneAndTogether) {
  const TestFolder folder;
  simulated(folder, "--laser beam --captures 8 --seed 5");
  const Rig exact = readRig(folder / "board.truth_rig.yaml");
  const Outcome camera =
      thermovox(folder.path(), "calibrate camera board -o camera.yaml --camera visible --json");
  ASSERT_EQ(camera.code, 0) << camera.err;
  EXPECT_NEAR(readRig(folder / "camera.yaml").visible_camera->camera.fx(), exact.visible_camera->camera.fx(),
              5.0);  // 0.3 %: eight views
  const Outcome stereo = thermovox(folder.path(), "calibrate stereo board -o stereo.yaml");
  ASSERT_EQ(stereo.code, 0) << stereo.err;
  EXPECT_THAT(stereo.out, testing::HasSubstr("T_body_camera of the visible camera"));
  const Vector6d error = errorOf(readRig(folder / "stereo.yaml").visible_camera->T_body_camera,
                                 exact.visible_camera->T_body_camera);
  EXPECT_LT(error.head<3>().norm(), 0.3 * kDegree);
  EXPECT_LT(error.tail<3>().norm(), 0.003);
}

TEST(CalibrateVerb, GivesTheSameBytesForAnyNumberOfThreads) {
  const TestFolder folder;
  simulated(folder, "--laser scan --captures 6");
  ASSERT_EQ(thermovox(folder.path(), "calibrate laser board -o one.yaml --threads 1").code, 0);
  ASSERT_EQ(thermovox(folder.path(), "calibrate laser board -o three.yaml --threads 3").code, 0);
  EXPECT_EQ(bytesOf(folder / "one.yaml"), bytesOf(folder / "three.yaml"));
}

TEST(CalibrateVerb, KnowsWrongUsage) {
  const TestFolder folder;
  simulated(folder, "--laser beam --captures 1");
  for (const char* arguments :
       {"calibrate", "calibrate laser", "calibrate laser board", "calibrate lens board -o rig.yaml",
        "calibrate laser board -o rig.txt", "calibrate camera board -o rig.yaml --camera infrared",
        "calibrate laser board -o rig.yaml --mission m", "calibrate laser --mission m --refine",
        "calibrate laser board -o rig.yaml --refine", "calibrate stereo board -o rig.yaml --laser 1"}) {
    const Outcome outcome = thermovox(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << ": " << outcome.err;
  }
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

TEST(CalibrateVerb, NamesWhatIsDamagedOrMissing) {
  const TestFolder folder;
  const fs::path board = simulated(folder, "--laser cloud --captures 2");
  const std::string verb = "calibrate laser board -o rig.yaml";
  expectRefused(folder.path(), verb + " --laser 1", {"rig.yaml", "laser"});
  fs::resize_file(board / "001_cloud.pcd", 1000);
  expectRefused(folder.path(), verb, {"001_cloud.pcd"});
  fs::resize_file(board / "000_thermal.tiff", 100);
  expectRefused(folder.path(), verb, {"000_thermal.tiff"});
  fs::remove(board / "000_visible.jpg");
  expectRefused(folder.path(), verb, {"000_visible.jpg", "captures.csv"});
  EXPECT_FALSE(fs::exists(folder / "rig.yaml"));
}

TEST(CalibrateVerb, ReplacesARigOnlyWhenTold) {
  const TestFolder folder;
  simulated(folder, "--laser cloud --captures 4");
  writeRig(folder / "rig.yaml", {});
  expectRefused(folder.path(), "calibrate laser board -o rig.yaml", {"rig.yaml", "exists already"});
  EXPECT_EQ(thermovox(folder.path(), "calibrate laser board -o rig.yaml --force").code, 0);
  EXPECT_EQ(readRig(folder / "rig.yaml").lasers.size(), 1U);
}

class GivenCaptures : public testing::TestWithParam<const char*> {};

// Made by an independent program; the error has to be within the error bar, at 1 in 1000.
TEST_P(GivenCaptures, AreCalibratedWithinTheErrorBar) {
  THERMOVOX_NEEDS_RECORDINGS();
  const TestFolder folder;
  const fs::path captures = *recordings() / "captures";
  const std::string name = GetParam();
  const Outcome outcome = thermovox(
      folder.path(), fmt::format("calibrate laser '{}' -o rig.yaml --json", (captures / name).string()));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("captures_used"), 12);
  EXPECT_TRUE(outcome.json().at("images_without_board").empty());
  const Laser found = readRig(folder / "rig.yaml").lasers[0];
  const Pose truth = readRig(captures / (name + ".truth_rig.yaml")).lasers[0].T_body_laser;
  Vector6d error = errorOf(found.T_body_laser, truth);
  if (found.kind == LaserKind::beam) {  // its roll is nobody's
    error.head<3>() = (truth.rotation * Eigen::Vector3d::UnitX())
                          .cross(found.T_body_laser.rotation * Eigen::Vector3d::UnitX());
  }
  const Eigen::CompleteOrthogonalDecomposition<Matrix6d> covariance(found.covariance_body_laser);
  EXPECT_LT(error.dot(covariance.solve(error)), 22.5) << error.transpose();
}

INSTANTIATE_TEST_SUITE_P(Kinds, GivenCaptures, testing::Values("board-beam", "board-scan", "board-cloud"),
                         [](const auto& about) { return std::string(about.param).substr(6); });

// Real: a VLP-16 and a fisheye camera. The publishers' own calibrations from three captures each scatter by
// 0.0116 0.0108 0.0069 rad and 4 18 30 mm about what they published; only a fifth of them are within 0.5
// degrees and 35 mm of it. Ours, from six captures, has to be within three of its own sigmas and a degree.
TEST(RealCaptures, AreCalibratedNearThePublishedExtrinsics) {
  THERMOVOX_NEEDS_RECORDINGS();
  const TestFolder folder;
  const fs::path captures = *recordings() / "captures" / "acfr";
  const Outcome outcome =
      thermovox(folder.path(),
                fmt::format("calibrate laser '{}' -o rig.yaml --camera visible --json", captures.string()));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(outcome.json().at("rms_px").get<double>(), 0.4);
  const Rig rig = readRig(folder / "rig.yaml");
  const Eigen::Matrix3d R_laser_camera = (Eigen::AngleAxisd(-1.4927, Eigen::Vector3d::UnitZ()) *
                                          Eigen::AngleAxisd(-0.0234, Eigen::Vector3d::UnitY()) *
                                          Eigen::AngleAxisd(-1.6963, Eigen::Vector3d::UnitX()))
                                             .toRotationMatrix();
  const Pose T_laser_camera{Eigen::Quaterniond(R_laser_camera), {0.0622, 0.0033, -0.1908}};
  const Pose published = rig.visible_camera->T_body_camera * T_laser_camera.inverse();
  const Vector6d error = errorOf(rig.lasers[0].T_body_laser, published);
  EXPECT_LT(error.head<3>().norm(), 1.0 * kDegree);
  EXPECT_LT(error.tail<3>().norm(), 0.045);
  const Vector6d sigmas = rig.lasers[0].covariance_body_laser.diagonal().cwiseSqrt();
  EXPECT_LT(error.cwiseQuotient(sigmas).cwiseAbs().maxCoeff(), 3.0)
      << error.cwiseQuotient(sigmas).transpose();
}

}  // namespace
}  // namespace thermovox::test
