#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "io/csv.hpp"
#include "io/octomap_file.hpp"
#include "io/station_schema.hpp"
#include "mapping/surface_cloud.hpp"
#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::record;
using test::sameMap;
using test::TestFolder;
using testing::IsEmpty;

const fs::path kData = fs::path(THERMOVOX_SOURCE_DIR) / "tests" / "data";
const fs::path kVersion1 = kData / "station_v1.tvx";
const fs::path kVersion2 = kData / "station_v2.tvx";

/// A row of the cloud that the program of that time exported.
struct OldPoint {
  Eigen::Vector3d p_world;
  double celsius, sigma, count, time;
};

std::vector<OldPoint> oldPoints(const char* name) {
  std::ifstream file(kData / name);
  std::string line;
  std::getline(file, line);  // names
  std::vector<OldPoint> points;
  while (std::getline(file, line)) {
    std::vector<double> row;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) row.push_back(std::stod(field));
    points.push_back({{row.at(0), row.at(1), row.at(2)}, row.at(4), row.at(5), row.at(6), row.at(7)});
  }
  return points;
}

TEST(StationMigration, ReadsVersion1AsItIs) {
  const std::string before = test::bytesOf(kVersion1);
  const Station station = Station::open(kVersion1);
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_EQ(station.options().resolution, 0.2);
  EXPECT_EQ(station.counts(), (Station::Counts{2, 6, 103, 616}));
  const std::vector<MissionRecord> missions = station.missions();
  EXPECT_EQ(missions.at(0).name, "monday");
  EXPECT_EQ(missions.at(1).points, 6486);
  EXPECT_EQ(missions.at(1).mapped_at, 1700000000);
  EXPECT_FALSE(missions.at(1).T_world_mission);
  EXPECT_EQ(test::bytesOf(kVersion1), before);
}

// The tolerances are today's quanta: 2^-9 C rounded in the sums, sigmas through weights in 2^-10 / C^2,
// stamps in 2^15 ns, places unchanged.
TEST(StationMigration, KeepsSurfacesWithinTodaysQuanta) {
  const ThermalMap map = Station::open(kVersion1).loadMap();
  const std::vector<OldPoint> points = oldPoints("station_v1.csv");
  ASSERT_EQ(points.size(), map.surfaceCount());
  int with_temperature = 0;
  for (const OldPoint& old : points) {
    SCOPED_TRACE(testing::Message() << old.p_world.transpose());
    const CellKey key = map.keyOf(old.p_world);
    const SurfaceCell* cell = map.surface(key);
    ASSERT_NE(cell, nullptr);
    const Eigen::Vector3d p_world =
        (Eigen::Vector3d(key.x, key.y, key.z) + cell->meanOffset()) * map.resolution();
    EXPECT_LT((p_world - old.p_world).norm(), 2e-6);  // the CSV has floats
    ASSERT_EQ(static_cast<double>(cell->observations), old.count);
    if (old.count == 0) continue;
    ++with_temperature;
    EXPECT_NEAR(cell->mean(), old.celsius, 1.0 / 1024 + 1e-4);
    EXPECT_NEAR(cell->sigmaOfMean(), old.sigma, 0.05 * old.sigma + 0.02);
    EXPECT_NEAR(toUnixSeconds(cell->last()), old.time, 4e-5);
    EXPECT_LE(cell->first(), cell->last());
    EXPECT_LE(cell->minCelsius(), cell->mean() + 0.04);
    EXPECT_GE(cell->maxCelsius(), cell->mean() - 0.04);
  }
  EXPECT_GT(with_temperature, 100);
}

TEST(StationMigration, KeepsOccupancy) {
  const TestFolder folder;
  writeBt(folder / "now.bt", Station::open(kVersion1).loadMap(), Existing::refuse);
  EXPECT_EQ(test::bytesOf(folder / "now.bt"), test::bytesOf(kData / "station_v1.bt"));
}

TEST(StationMigration, AWriterMakesItTheVersionOfToday) {
  const TestFolder folder;
  const fs::path path = folder / "plant.tvx";
  fs::copy_file(kVersion1, path);
  const ThermalMap before = Station::open(path).loadMap();
  Station::open(path).addMission(record("m3"), ThermalMap(before.options()), KnownMission::refuse);
  const Station station = Station::open(path);
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_EQ(station.counts().missions, 3);
  EXPECT_TRUE(sameMap(station.loadMap(), before));
  const SqlDatabase database(path, SqlDatabase::Mode::read, "plant.tvx");
  EXPECT_EQ(database.integer("PRAGMA user_version"), kStationSchema);
  EXPECT_EQ(database.integer("SELECT count(*) FROM missions WHERE T_world_mission IS NULL"), 3);
}

TEST(StationMigration, ReadsVersion2ToTheBit) {
  const Station station = Station::open(kVersion2);
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_EQ(station.counts(), (Station::Counts{2, 6, 103, 616}));
  const ThermalMap map = station.loadMap();
  const std::vector<OldPoint> points = oldPoints("station_v2.csv");
  ASSERT_EQ(points.size(), map.surfaceCount());
  int with_temperature = 0;
  for (const OldPoint& old : points) {
    SCOPED_TRACE(testing::Message() << old.p_world.transpose());
    const SurfaceCell* cell = map.surface(map.keyOf(old.p_world));
    ASSERT_NE(cell, nullptr);
    ASSERT_EQ(static_cast<double>(cell->observations), old.count);
    if (old.count == 0) continue;
    ++with_temperature;
    EXPECT_EQ(cell->commonSigma(), 0.0);                                   // which was not known then
    EXPECT_NEAR(cell->mean(), old.celsius, 1e-6 * std::abs(old.celsius));  // the CSV has floats
    EXPECT_NEAR(cell->sigmaOfMean(), old.sigma, 1e-6 * old.sigma);
    EXPECT_NEAR(toUnixSeconds(cell->last()), old.time, 1e-6);
  }
  EXPECT_GT(with_temperature, 100);
}

TEST(StationMigration, Version2IsContinuedAndMergedAsTheVersionOfToday) {
  const TestFolder folder;
  const fs::path path = folder / "plant.tvx";
  fs::copy_file(kVersion2, path);
  ThermalMap both = Station::open(path).loadMap();
  ThermalMap mission(both.options());
  const Eigen::Vector3d p_world(0.1, 0.1, 0.1);
  const TemperatureObservation grazing{.celsius = 30.0F, .sigma = 0.1F, .common_sigma = 2.0F};
  mission.integrate({{{p_world, p_world, Time{}, grazing}}}, Carving::none);
  Station::open(path).addMission(record("m3"), mission, KnownMission::refuse);
  both.merge(mission);
  const Station station = Station::open(path);
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_TRUE(sameMap(station.loadMap(), both));
  const SqlDatabase database(path, SqlDatabase::Mode::read, "plant.tvx");
  EXPECT_EQ(database.integer("PRAGMA user_version"), kStationSchema);
}

}  // namespace
}  // namespace thermovox
