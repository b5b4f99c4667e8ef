#include "apps/calibrate_mission.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/arguments.hpp"
#include "apps/simulate/mission_writer.hpp"
#include "io/rig_file.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Args = MissionRefinementArgs;

/// A mission whose rig is true, its images coarsely sampled to be quick.
fs::path fly(const TestFolder& folder, LaserKind laser, double seconds) {
  simulate::SimulationOptions options;
  options.laser = laser;
  options.seed = 3;
  options.duration = seconds;
  options.supersampling = 2;
  simulate::simulateMission(options, folder / "mission");
  return folder / "mission";
}

/// What it says on stdout.
std::string wordsOf(const Args& args) {
  testing::internal::CaptureStdout();
  try {
    runMissionRefinement(args);
  } catch (...) {
    static_cast<void>(testing::internal::GetCapturedStdout());
    throw;
  }
  return testing::internal::GetCapturedStdout();
}

nlohmann::json found(const Args& args) {
  return nlohmann::json::parse(wordsOf(args));
}

/// The words of the error of this type; fails where there is none.
template <typename Expected>
std::string refusalOf(const Args& args) {
  try {
    static_cast<void>(wordsOf(args));
  } catch (const Expected& error) {
    return error.what();
  }
  ADD_FAILURE() << "expected an error";
  return "";
}

/// A point 5 m before the laser: how far another rig puts it from where this one does, metres.
double displacement(const Rig& a, const Rig& b) {
  double most = 0.0;
  for (const double side : {-2.0, 0.0, 2.0}) {
    const Eigen::Vector3d p(4.5, side, 0.0);
    most = std::max(most, (a.lasers[0].T_body_laser * p - b.lasers[0].T_body_laser * p).norm());
  }
  return most;
}

TEST(CalibrateOnAMission, LeavesATrueRigAsItIs) {
  const TestFolder folder;
  const fs::path mission = fly(folder, LaserKind::scan, 12.0);
  const Args args{.mission = mission,
                  .rig = mission / "rig.yaml",
                  .refined = folder / "out.yaml",
                  .output = Args::Output::json};
  const nlohmann::json json = found(args);
  EXPECT_EQ(json.at("refined"), false);
  EXPECT_EQ(json.at("consistent"), true) << json;
  EXPECT_GT(json.at("edges"), 500);
  EXPECT_EQ(json.at("rotation_change_deg").size(), 3U);
  EXPECT_EQ(json.at("translation_sigma_mm").size(), 3U);
  EXPECT_NEAR(json.at("time_offset_change_ms").get<double>(), 0.0,
              3.0 * json.at("time_offset_sigma_ms").get<double>());
  EXPECT_EQ(bytesOf(folder / "out.yaml"), rigText(readRig(mission / "rig.yaml"))) << "scripts go on with it";
  EXPECT_THAT(refusalOf<DataError>(args), HasSubstr("out.yaml")) << "which is there now";
  Args table = args;
  table.force = true;
  table.output = Args::Output::table;
  EXPECT_THAT(wordsOf(table), HasSubstr("nothing was refined"));
}

TEST(CalibrateOnAMission, RefinesARigThatIsOff) {
  const TestFolder folder;
  const fs::path mission = fly(folder, LaserKind::scan, 12.0);
  const Rig truth = readRig(mission / "rig.yaml");
  Rig off = truth;
  Pose& T_body_laser = off.lasers[0].T_body_laser;
  T_body_laser = {expRotation({0.006, -0.006, 0.016}) * T_body_laser.rotation,
                  T_body_laser.translation + Eigen::Vector3d(0.01, -0.01, 0.01)};
  writeRig(folder / "off.yaml", off);
  const nlohmann::json json = found({.mission = mission,
                                     .rig = folder / "off.yaml",
                                     .refined = folder / "out.yaml",
                                     .output = Args::Output::json});
  EXPECT_EQ(json.at("refined"), true) << json;
  EXPECT_EQ(json.at("consistent"), false);
  EXPECT_LT(json.at("rms_px_refined"), json.at("rms_px"));
  const Rig refined = readRig(folder / "out.yaml");
  EXPECT_LT(displacement(refined, truth), 0.5 * displacement(off, truth));
  EXPECT_GT(refined.lasers[0].covariance_body_laser.diagonal().minCoeff(), 0.0);
  EXPECT_EQ(refined.thermal_camera->T_body_camera, truth.thermal_camera->T_body_camera)
      << "stays where it is";
}

TEST(CalibrateOnAMission, SaysWhatCannotBe) {
  const TestFolder folder;
  const fs::path mission = fly(folder, LaserKind::beam, 1.0);
  EXPECT_THAT(refusalOf<UsageError>({.mission = mission, .laser = 3}), HasSubstr("found 3, expected 0 to 0"));
  Rig rig = readRig(mission / "rig.yaml");
  rig.lasers[0].kind = LaserKind::scan;
  writeRig(folder / "scan.yaml", rig);
  EXPECT_THAT(refusalOf<ConfigError>({.mission = mission, .rig = folder / "scan.yaml"}),
              HasSubstr("of kind scan, expected beam"));
  rig.thermal_camera.reset();
  writeRig(folder / "blind.yaml", rig);
  EXPECT_THAT(refusalOf<ConfigError>({.mission = mission, .rig = folder / "blind.yaml"}),
              HasSubstr("has no thermal_camera"));
  rig.lasers.clear();
  writeRig(folder / "bare.yaml", rig);
  EXPECT_THAT(refusalOf<ConfigError>({.mission = mission, .rig = folder / "bare.yaml"}),
              HasSubstr("has no laser"));
  EXPECT_THAT(refusalOf<UnobservableError>({.mission = mission, .refined = folder / "out.yaml"}),
              HasSubstr("no temperature edges at depth edges"));
  EXPECT_FALSE(fs::exists(folder / "out.yaml"));
}

}  // namespace
}  // namespace thermovox::test
