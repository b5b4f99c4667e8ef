// The verb map in two passes, painting, and with geometry from elsewhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/station.hpp"
#include "tests/apps/program.hpp"

namespace thermovox::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

nlohmann::json mapped(const TestFolder& folder, const std::string& arguments) {
  const Outcome outcome = runShell(folder.path(), std::string("SOURCE_DATE_EPOCH=1700000000 ") + kThermovox +
                                                      "map --json --resolution 0.1 " + arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome.json();
}

/// Rows of the station's CSV that have a temperature.
std::size_t colouredCells(const TestFolder& folder, const std::string& station) {
  EXPECT_EQ(thermovox(folder.path(), "export " + station + " cells.csv --force").code, 0);
  std::istringstream cells(bytesOf(folder / "cells.csv"));
  std::size_t coloured = 0;
  std::string line;
  std::getline(cells, line);
  while (std::getline(cells, line)) {
    std::istringstream row(line);
    std::string field;
    for (int column = 0; column < 5; ++column) std::getline(row, field, ',');
    coloured += !field.empty() && field != "nan";
  }
  return coloured;
}

/// A mission of a cloud and one of a beam in the same hall.
void flyCloudAndBeam(const TestFolder& folder) {
  simulate::SimulationOptions options{.laser = LaserKind::cloud, .seed = 3, .duration = 1.0};
  options.supersampling = 1;
  simulate::simulateMission(options, folder / "cloud");
  options.laser = LaserKind::beam;
  options.seed = 4;
  options.hall_seed = 3;
  simulate::simulateMission(options, folder / "beam");
}

/// What a mission's parameters in the station say of the missions whose geometry it painted.
nlohmann::json sceneOf(const fs::path& station, const std::string& name) {
  for (const MissionRecord& mission : Station::open(station).missions()) {
    if (mission.name == name)
      return nlohmann::json::parse(mission.parameters).value("scene", nlohmann::json());
  }
  return {};
}

TEST(MapInTwoPasses, HasTheSameGeometryAndSaysSo) {
  const TestFolder folder;
  flyMission(folder, "hall", LaserKind::scan);
  const nlohmann::json once = mapped(folder, "hall --station once.tvx");
  const nlohmann::json twice = mapped(folder, "hall --station twice.tvx --two-pass --points p.csv");
  EXPECT_EQ(once.at("points"), twice.at("points"));
  EXPECT_EQ(once.at("voxels"), twice.at("voxels"));
  EXPECT_LE(twice.at("coloured"), once.at("coloured"));
  EXPECT_EQ(twice.at("painted"), 0);
  for (const char* name : {"once", "twice"}) {
    ASSERT_EQ(thermovox(folder.path(), fmt::format("export {0}.tvx {0}.bt", name)).code, 0);
  }
  EXPECT_TRUE(bytesOf(folder / "once.bt") == bytesOf(folder / "twice.bt"));
  EXPECT_EQ(thermovox(folder.path(), "info twice.tvx --verify").code, 0);
}

TEST(MapInTwoPasses, PaintingColoursMoreAndGivesTheSameBytesAgain) {
  const TestFolder folder;
  flyMission(folder, "hall", LaserKind::scan);
  (void)mapped(folder, "hall --station plain.tvx");
  const nlohmann::json painted = mapped(folder, "hall --station a.tvx --two-pass --paint --points a.csv");
  (void)mapped(folder, "hall --station b.tvx --paint --points b.csv");  // --paint takes two passes anyway
  EXPECT_TRUE(bytesOf(folder / "a.tvx") == bytesOf(folder / "b.tvx"));
  EXPECT_TRUE(bytesOf(folder / "a.csv") == bytesOf(folder / "b.csv"));
  EXPECT_EQ(colouredCells(folder, "a.tvx"), painted.at("painted"));
  EXPECT_GT(colouredCells(folder, "a.tvx"), colouredCells(folder, "plain.tvx"));
  EXPECT_EQ(thermovox(folder.path(), "info a.tvx --verify").code, 0);
}

TEST(MapInTwoPasses, ABeamPaintsAnEarlierMissionsMap) {
  const TestFolder folder;
  flyCloudAndBeam(folder);
  const nlohmann::json before = mapped(folder, "cloud --station s.tvx");
  const nlohmann::json after = mapped(folder, "beam --station s.tvx --paint");
  EXPECT_GT(after.at("painted"), 1000);
  EXPECT_EQ(sceneOf(folder / "s.tvx", "beam"), nlohmann::json({"cloud"}));
  EXPECT_TRUE(sceneOf(folder / "s.tvx", "cloud").is_null());
  EXPECT_LT(after.at("voxels").get<int>(), before.at("voxels").get<int>() + 200);  // its own returns
  EXPECT_EQ(thermovox(folder.path(), "info s.tvx --verify").code, 0);
}

TEST(ImportedGeometry, EntersTheStationOnceAndIsPainted) {
  const TestFolder folder;
  flyCloudAndBeam(folder);
  const nlohmann::json cloud = mapped(folder, "cloud --station cloud.tvx");
  for (const std::string name : {"plant.ply", "plant2.pcd"}) {
    ASSERT_EQ(thermovox(folder.path(), "export cloud.tvx " + name).code, 0);
    const nlohmann::json alone = mapped(folder, "--geometry " + name + " --station " + name + ".tvx");
    EXPECT_EQ(alone.at("voxels"), cloud.at("voxels"));
    EXPECT_EQ(alone.at("missions").size(), 0U);
  }
  const nlohmann::json both = mapped(folder, "beam --geometry plant.ply --paint --station s.tvx");
  EXPECT_GT(both.at("painted"), 1000);
  EXPECT_EQ(both.at("mission"), "beam");
  EXPECT_EQ(sceneOf(folder / "s.tvx", "beam"), nlohmann::json({"plant"}));
  const nlohmann::json info = thermovox(folder.path(), "info s.tvx --json").json();
  EXPECT_EQ(info.at("missions").size(), 2U);
  expectRefused(folder.path(), "map --geometry plant.ply --station s.tvx", {"s.tvx", "'plant'", "--again"});
  (void)mapped(folder, "--geometry plant2.pcd --station s.tvx");
  EXPECT_EQ(thermovox(folder.path(), "info s.tvx --verify").code, 0);
}

TEST(ImportedGeometry, ThatCannotBeReadIsRefused) {
  const TestFolder folder;
  expectRefused(folder.path(), "map --geometry nowhere.ply", {"nowhere.ply", "--geometry"});
  folder.write("broken.pcd", "VERSION 0.7\nFIELDS x y z\n");
  expectRefused(folder.path(), "map --geometry broken.pcd", {"broken.pcd"});
  EXPECT_EQ(thermovox(folder.path(), "map --geometry cloud.las").code, 2);
  EXPECT_EQ(thermovox(folder.path(), "map").code, 2);
}

}  // namespace
}  // namespace thermovox::test
