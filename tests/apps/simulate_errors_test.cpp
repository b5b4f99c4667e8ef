// What a simulated mission declares of its errors is what it is made with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/simulate/hall_layout.hpp"
#include "apps/simulate/simulation.hpp"
#include "io/mission_folder.hpp"
#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

using namespace simulate;

constexpr double kDegree = M_PI / 180.0;
const std::string kErrors =
    " --extrinsic-sigma 0.3 0.008 --pose-sigma 0.2 0.01 --range-bias-sigma 0.02 --bias-sigma 2";

nlohmann::json truthOf(const TestFolder& folder, const std::string& mission) {
  return nlohmann::json::parse(bytesOf(folder / (mission + ".truth.json")));
}

TEST(SimulatedErrors, AreDeclaredInTheFilesAndToldByTheTruth) {
  const TestFolder folder;
  ASSERT_EQ(thermovox(folder.path(), "simulate hall --laser scan --duration 0.5 --seed 5" + kErrors).code, 0);
  const OpenedMission opened = openMission(folder / "hall", {});
  const Mission& mission = opened.mission;
  EXPECT_NEAR(mission.pose_rotation_sigma, 0.2 * kDegree, 1e-8);
  EXPECT_NEAR(mission.pose_translation_sigma, 0.01, 1e-9);
  const Laser& laser = mission.rig.lasers.at(0);
  for (int i = 0; i < 6; ++i) {
    const double sigma = i < 3 ? 0.3 * kDegree : 0.008;
    EXPECT_NEAR(laser.covariance_body_laser(i, i), sigma * sigma, 1e-6 * sigma * sigma);
  }
  EXPECT_NEAR(laser.range_bias_sigma, 0.02, 1e-9);
  EXPECT_NEAR(mission.rig.thermal_camera->bias_sigma, 2.0, 1e-9);
  const nlohmann::json truth = truthOf(folder, "hall");
  EXPECT_NE(truth.at("camera_bias").get<double>(), 0.0);
  EXPECT_NE(truth.at("range_bias").get<double>(), 0.0);
  for (const char* part : {"rotation", "translation"}) {
    EXPECT_NE(truth.at("pose_error").at(part).at(0).get<double>(), 0.0) << part;
  }
}

TEST(SimulatedErrors, AreZeroWhereNoneAreDeclared) {
  const TestFolder folder;
  ASSERT_EQ(thermovox(folder.path(), "simulate hall --laser beam --duration 0.5").code, 0);
  const nlohmann::json truth = truthOf(folder, "hall");
  EXPECT_EQ(truth.at("camera_bias").get<double>(), 0.0);
  EXPECT_EQ(truth.at("range_bias").get<double>(), 0.0);
  EXPECT_EQ(truth.at("pose_error").at("rotation").at(2).get<double>(), 0.0);
}

TEST(SimulatedErrors, AreDrawnFromWhatIsDeclaredOncePerSeed) {
  SimulationOptions options;
  options.laser = LaserKind::beam;
  options.duration = 0.5;
  options.errors.pose_rotation_sigma = 0.003;
  options.errors.pose_translation_sigma = 0.01;
  options.errors.range_bias_sigma = 0.02;
  options.errors.camera_bias_sigma = 2.0;
  double rotation = 0.0, translation = 0.0, range = 0.0, camera = 0.0;
  constexpr int kSeeds = 400;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    const Simulation simulation(options);
    const DrawnErrors& drawn = simulation.drawnErrors();
    rotation += drawn.pose_rotation.squaredNorm() / 3.0 / kSeeds;
    translation += drawn.pose_translation.squaredNorm() / 3.0 / kSeeds;
    range += drawn.range_bias * drawn.range_bias / kSeeds;
    camera += drawn.camera_bias * drawn.camera_bias / kSeeds;
    EXPECT_EQ(Simulation(options).drawnErrors().camera_bias, drawn.camera_bias);
  }
  // Variances of 400 draws are good to 7 % at one sigma, those of 1200 to 4 %.
  EXPECT_NEAR(rotation / (0.003 * 0.003), 1.0, 0.16);
  EXPECT_NEAR(translation / (0.01 * 0.01), 1.0, 0.16);
  EXPECT_NEAR(range / (0.02 * 0.02), 1.0, 0.28);
  EXPECT_NEAR(camera / 4.0, 1.0, 0.28);
}

TEST(SimulatedErrors, ThatMakeNoSenseAreRefused) {
  const TestFolder folder;
  for (const char* option : {"--extrinsic-sigma 0.3", "--extrinsic-sigma -1 0.01", "--pose-sigma 0.1 -0.01",
                             "--pose-sigma nan 0", "--range-bias-sigma -0.1", "--bias-sigma x"}) {
    const Outcome outcome =
        thermovox(folder.path(), std::string("simulate hall --laser beam --duration 0.5 ") + option);
    EXPECT_NE(outcome.code, 0) << option;
    EXPECT_FALSE(std::filesystem::exists(folder / "hall")) << option;
  }
}

TEST(HallChanges, AreASeasonOtherJointsAndMoreBoxes) {
  const Hall built = makeHall(31);
  const HotSpot& joint = built.hotSpots().at(0);
  const Eigen::Vector3d from(joint.position.x(), 0.0, joint.position.z());
  const Eigen::Vector3d towards = (joint.position - from).normalized();
  const double before = built.castRay(from, towards)->temperature;
  EXPECT_NEAR(built.changed({.warmer = 7.0}).castRay(from, towards)->temperature, before + 7.0, 1e-9);
  const Hall mended = built.changed({.joint_rises = {{0, 0.0}}});
  EXPECT_NEAR(mended.castRay(from, towards)->temperature, before - joint.delta, 0.5);
  const Eigen::Vector3d middle = 0.5 * (from + joint.position);
  const Box box{middle.array() - 0.2, middle.array() + 0.2, 50.0};
  const Hall hidden = built.changed({.boxes = {box}});
  EXPECT_NEAR(hidden.castRay(from, towards)->temperature, 50.0, 0.5);
  EXPECT_LT(hidden.castRay(from, towards)->range, built.castRay(from, towards)->range);
}

}  // namespace
}  // namespace thermovox::test
