#include "apps/simulate/mission_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/simulate/thermal_render.hpp"
#include "io/mission_folder.hpp"
#include "projection/error.hpp"
#include "tests/apps/simulated_sweeps.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::simulate {
namespace {

namespace fs = std::filesystem;

/// All files under a folder with their bytes.
std::map<std::string, std::string> contentOf(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      content[fs::relative(entry.path(), folder).string()] = test::bytesOf(entry.path());
  }
  return content;
}

TEST(SimulateMission, SameSeedGivesSameBytesWithAnyNumberOfThreads) {
  for (const LaserKind kind : kKinds) {
    const test::TestFolder folder;
    SimulationOptions options = optionsOf(kind, 0.5);
    options.threads = 1;
    simulateMission(options, folder / "one" / "hall");
    options.threads = 4;
    simulateMission(options, folder / "two" / "hall");
    options.seed = 12;
    simulateMission(options, folder / "other" / "hall");
    EXPECT_EQ(contentOf(folder / "one"), contentOf(folder / "two"));
    EXPECT_NE(contentOf(folder / "one"), contentOf(folder / "other"));
  }
}

TEST(SimulateMission, SameSeedGivesSameRadiometricFrames) {
  const test::TestFolder folder;
  SimulationOptions options = optionsOf(LaserKind::beam, 0.5);
  options.frames = FrameFormat::rjpeg;
  options.threads = 1;
  simulateMission(options, folder / "one" / "hall");
  options.threads = 4;
  simulateMission(options, folder / "two" / "hall");
  EXPECT_EQ(contentOf(folder / "one"), contentOf(folder / "two"));
  options.humidity = 0.9;
  simulateMission(options, folder / "humid" / "hall");
  EXPECT_NE(contentOf(folder / "one"), contentOf(folder / "humid"));
}

TEST(SimulateMission, LeavesOnlyTheMissionAndItsTruth) {
  const test::TestFolder folder;
  simulateMission(optionsOf(LaserKind::cloud, 0.2), folder / "hall/");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) names.push_back(entry.path().filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre("hall", "hall.truth.json"));
  EXPECT_EQ(truthPath(folder / "hall"), folder / "hall.truth.json");
}

TEST(SimulateMission, RefusesToOverwriteAMissionOrATruth) {
  const test::TestFolder folder;
  fs::create_directory(folder / "hall");
  folder.write("hall/notes.txt", "mine");
  const auto fly = [&] { simulateMission(optionsOf(LaserKind::beam, 0.2), folder / "hall"); };
  EXPECT_THAT(test::messageOf<DataError>(fly), testing::HasSubstr("exists already"));
  EXPECT_TRUE(fs::exists(folder / "hall" / "notes.txt"));
  fs::remove_all(folder / "hall");
  folder.write("hall.truth.json", "{}");
  EXPECT_THAT(test::messageOf<DataError>(fly), testing::HasSubstr("truth.json: exists already"));
  EXPECT_FALSE(fs::exists(folder / "hall"));
}

TEST(SimulateMission, FillsAnEmptyFolder) {
  const test::TestFolder folder;
  fs::create_directory(folder / "hall");
  simulateMission(optionsOf(LaserKind::beam, 0.2), folder / "hall");
  EXPECT_TRUE(fs::exists(folder / "hall" / "mission.yaml"));
}

TEST(SimulateMission, AFailedRunLeavesNothing) {
  const test::TestFolder folder;
  const fs::path file = folder.write("a_file", "");
  EXPECT_THAT(
      test::messageOf<DataError>([&] { simulateMission(optionsOf(LaserKind::beam, 0.2), file / "hall"); }),
      testing::HasSubstr("could not be written"));
  EXPECT_EQ(contentOf(folder.path()).size(), 1U);
}

TEST(SimulateMission, TruthHasAllKeysAndTheHallItself) {
  for (const LaserKind kind : kKinds) {
    const test::TestFolder folder;
    const SimulationOptions options = optionsOf(kind, 0.3);
    simulateMission(options, folder / "hall");
    const auto truth = nlohmann::json::parse(test::bytesOf(folder / "hall.truth.json"));
    const Simulation simulation(options);
    EXPECT_EQ(truth.at("seed"), 11);
    EXPECT_EQ(truth.at("duration"), 0.3);
    EXPECT_THAT(truth.at("laser").get<std::string>(), testing::AnyOf("beam", "scan", "cloud"));
    EXPECT_GT(truth.at("readings"), 0);
    EXPECT_EQ(truth.at("size").at(1), simulation.hall().size().y());
    ASSERT_EQ(truth.at("boxes").size(), simulation.hall().boxes().size());
    EXPECT_EQ(truth.at("boxes").at(0).at(0).at(2), simulation.hall().boxes()[0].low.z());
    EXPECT_EQ(truth.at("boxes").at(0).at(1).at(0), simulation.hall().boxes()[0].high.x());
    EXPECT_EQ(truth.at("boxes").at(0).at(2), simulation.hall().boxes()[0].celsius);
    ASSERT_EQ(truth.at("cyls").size(), simulation.hall().cylinders().size());
    EXPECT_EQ(truth.at("cyls").at(0).size(), 5U);
    ASSERT_EQ(truth.at("hotspots").size(), simulation.hall().hotSpots().size());
    for (const char* key : {"position", "delta", "sigma", "peak"})
      EXPECT_TRUE(truth["hotspots"][0].contains(key));
  }
}

TEST(SimulateMission, OpensAsAMissionWithEveryReadingAndFrame) {
  for (const LaserKind kind : kKinds) {
    const test::TestFolder folder;
    SimulationOptions options = optionsOf(kind, 1.0);
    options.errors.pose_rotation_sigma = 0.001;
    options.errors.covariance_body_laser = 1e-6 * Matrix6d::Identity();
    simulateMission(options, folder / "hall");
    OpenedMission opened = openMission(folder / "hall");
    const Simulation simulation(options);
    EXPECT_EQ(opened.mission.name, "hall");
    EXPECT_EQ(opened.mission.pose_rotation_sigma, 0.001);
    ASSERT_EQ(opened.mission.rig.lasers.size(), 1U);
    EXPECT_EQ(opened.mission.rig.lasers[0].kind, kind);
    EXPECT_EQ(opened.mission.rig.lasers[0].covariance_body_laser(4, 4), 1e-6);
    EXPECT_EQ(opened.mission.trajectory.poses().size(), simulation.writtenPoses().size());
    for (std::size_t sweep = 0; sweep < simulation.sweepCount(); ++sweep) {
      const std::optional<Reading> reading = opened.readings->next();
      const Reading expected = readSweep(simulation, sweep);
      ASSERT_TRUE(reading);
      EXPECT_EQ(reading->stamp, expected.stamp);
      ASSERT_EQ(reading->returns.size(), expected.returns.size());
      for (std::size_t i = 0; i < expected.returns.size(); ++i) {
        ASSERT_EQ(reading->returns[i].stamp, expected.returns[i].stamp);
        ASSERT_LT((reading->returns[i].p_laser - expected.returns[i].p_laser).norm(), 1e-4);  // four decimals
      }
    }
    EXPECT_FALSE(opened.readings->next());
    const ThermalRenderer renderer(simulation);
    for (std::size_t frame = 0; frame < simulation.frameCount(); ++frame) {
      const std::optional<ThermalFrame> read = opened.frames->next();
      ASSERT_TRUE(read);
      EXPECT_EQ(read->stamp, simulation.frameStamp(frame));
      const float first = simulation.rig().thermal_camera->t_linear->celsius(renderer.counts(frame)[0]);
      EXPECT_EQ(read->image->at(0, 0), first);
    }
    EXPECT_FALSE(opened.frames->next());
  }
}

}  // namespace
}  // namespace thermovox::simulate
