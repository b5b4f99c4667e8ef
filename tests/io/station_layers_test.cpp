// What a station keeps of each mission besides its share of the map: its own temperatures, and what it
// declares of its errors.
#include <random>

#include "io/station_merge.hpp"
#include "mapping/moved_map.hpp"
#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;
using test::executeSql;
using test::missionName;
using test::randomMission;
using test::record;
using test::sameMap;
using test::stationOf;
using test::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The surfaces of a map that have a temperature, and nothing else.
ThermalMap temperaturesOf(const ThermalMap& map) {
  ThermalMap layer(map.options());
  for (const BlockKey& key : map.sortedBlockKeys()) {
    Block block;
    map.block(key)->forEachSurface([&](int index, const SurfaceCell& cell) {
      if (cell.observations > 0) block.surfaceOrNew(index) = cell;
    });
    if (block.surfaceCount() > 0) layer.setBlock(key, std::move(block));
  }
  return layer;
}

MissionRecord fullRecord(unsigned seed) {
  MissionRecord mission = record(missionName(seed));
  mission.first = Time(std::chrono::seconds(seed));
  mission.ambient = 17.25;
  mission.pose_sigmas = {0.001, 0.02};
  SharedMotion motion;
  motion.cube = {static_cast<std::int32_t>(seed), -1, 0};
  motion.count = 10 * seed;
  motion.by_translation.setIdentity();
  motion.by_range = {0.6F, 0.0F, 0.8F};
  motion.lever = {1.0F, 2.0F, 3.0F};
  mission.shared_motions = {motion};
  mission.frame_poses = {
      {Time(std::chrono::seconds(seed)), {Eigen::Quaterniond::Identity(), {1.0, 2.0, 3.0}}}};
  return mission;
}

fs::path fullStation(const TestFolder& folder, const std::vector<unsigned>& seeds, const char* name) {
  const fs::path path = folder / name;
  Station station = Station::create(path, randomMission(0).options());
  for (const unsigned seed : seeds) {
    station.addMission(fullRecord(seed), randomMission(seed), KnownMission::refuse);
  }
  return path;
}

void expectSameMotions(const std::vector<SharedMotion>& a, const std::vector<SharedMotion>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].cube, b[i].cube);
    EXPECT_EQ(a[i].count, b[i].count);
    EXPECT_EQ(a[i].by_translation, b[i].by_translation);
    EXPECT_EQ(a[i].by_range, b[i].by_range);
    EXPECT_EQ(a[i].lever, b[i].lever);
  }
}

TEST(StationLayers, AreTheMissionsOwnTemperatures) {
  const TestFolder folder;
  const Station station = Station::open(stationOf(folder, {3, 1, 2}));
  const std::vector<MissionRecord> missions = station.missions();
  ASSERT_EQ(missions.size(), 3U);
  for (std::size_t i = 0; i < missions.size(); ++i) {
    const auto seed = static_cast<unsigned>(std::stoi(missions[i].name.substr(1)));
    const std::optional<ThermalMap> layer = station.loadLayer(i);
    ASSERT_TRUE(layer);
    EXPECT_TRUE(sameMap(*layer, temperaturesOf(randomMission(seed)))) << missions[i].name;
  }
  EXPECT_FALSE(station.loadLayer(3));
  EXPECT_GT(station.counts().layer_tiles, 0);
  EXPECT_THAT(station.verify(), IsEmpty());
}

TEST(StationLayers, AddUpToTheTemperaturesOfTheMap) {
  const TestFolder folder;
  const Station station = Station::open(stationOf(folder, {1, 2}));
  ThermalMap sum(station.options());
  for (const std::size_t i : {0U, 1U}) sum.merge(*station.loadLayer(i));
  forEachSurface(station.loadMap(), [&](const CellKey& key, const SurfaceCell& cell) {
    if (cell.observations == 0) return;
    ASSERT_NE(sum.surface(key), nullptr);
    EXPECT_EQ(sum.surface(key)->mean(), cell.mean());
    EXPECT_EQ(sum.surface(key)->sigmaOfMean(), cell.sigmaOfMean());
  });
}

TEST(StationLayers, OfAMissionWithoutTemperaturesIsEmptyAndThere) {
  const TestFolder folder;
  ThermalMap geometry(randomMission(0).options());
  const Eigen::Vector3d p_world(0.5, 0.5, 0.5);
  geometry.integrate({{{p_world, p_world, Time{}, std::nullopt}}}, Carving::none);
  Station::create(folder / "plant.tvx", geometry.options())
      .addMission(record("dark"), geometry, KnownMission::refuse);
  const std::optional<ThermalMap> layer = Station::open(folder / "plant.tvx").loadLayer(0);
  ASSERT_TRUE(layer);
  EXPECT_EQ(layer->surfaceCount(), 0U);
}

TEST(StationLayers, KeepWhatTheMissionDeclares) {
  const TestFolder folder;
  const std::vector<MissionRecord> missions =
      Station::open(fullStation(folder, {1, 2}, "plant.tvx")).missions();
  for (const unsigned seed : {1U, 2U}) {
    const MissionRecord &read = missions.at(seed - 1), wrote = fullRecord(seed);
    EXPECT_EQ(read.ambient, wrote.ambient);
    EXPECT_EQ(read.pose_sigmas.rotation, wrote.pose_sigmas.rotation);
    EXPECT_EQ(read.pose_sigmas.translation, wrote.pose_sigmas.translation);
    expectSameMotions(read.shared_motions, wrote.shared_motions);
    ASSERT_EQ(read.frame_poses.size(), 1U);
    EXPECT_EQ(read.frame_poses[0].T_world_camera, wrote.frame_poses[0].T_world_camera);
  }
}

TEST(StationLayers, AreTheSameBytesInWhateverOrderMissionsCame) {
  const TestFolder folder;
  const std::string expected = bytesOf(fullStation(folder, {1, 2, 3}, "expected.tvx"));
  EXPECT_TRUE(bytesOf(fullStation(folder, {3, 1, 2}, "other.tvx")) == expected);
  EXPECT_TRUE(bytesOf(fullStation(folder, {2, 3, 1}, "third.tvx")) == expected);
}

TEST(StationLayers, AreKeptByAMerge) {
  const TestFolder folder;
  const fs::path a = fullStation(folder, {1, 3}, "a.tvx"), b = fullStation(folder, {2}, "b.tvx");
  const std::vector<MergeInput> inputs{{b, std::nullopt}, {a, std::nullopt}};
  mergeStations(inputs, folder / "out.tvx", Existing::refuse);
  EXPECT_TRUE(bytesOf(folder / "out.tvx") == bytesOf(fullStation(folder, {1, 2, 3}, "all.tvx")));
  const Station station = Station::open(folder / "out.tvx");
  for (const unsigned seed : {1U, 2U, 3U}) {
    EXPECT_TRUE(sameMap(*station.loadLayer(seed - 1), temperaturesOf(randomMission(seed))));
    expectSameMotions(station.missions().at(seed - 1).shared_motions, fullRecord(seed).shared_motions);
  }
}

TEST(StationLayers, MoveWithTheirStation) {
  const TestFolder folder;
  const fs::path a = fullStation(folder, {1}, "a.tvx"), b = fullStation(folder, {2}, "b.tvx");
  const Pose T_a_b{expRotation({0.0, 0.0, 0.5}), {4.0, -1.0, 0.3}};
  const std::vector<MergeInput> inputs{{a, std::nullopt}, {b, T_a_b}};
  mergeStations(inputs, folder / "out.tvx", Existing::refuse);
  const Station station = Station::open(folder / "out.tvx");
  EXPECT_THAT(station.verify(), IsEmpty());
  EXPECT_TRUE(sameMap(*station.loadLayer(0), temperaturesOf(randomMission(1))));
  ThermalMap moved_layer(station.options());
  addMoved(temperaturesOf(randomMission(2)), T_a_b, moved_layer);
  EXPECT_TRUE(sameMap(*station.loadLayer(1), temperaturesOf(moved_layer)));
  const MissionRecord mission = station.missions().at(1);
  expectSameMotions(mission.shared_motions, moved(fullRecord(2).shared_motions, T_a_b));
  const Eigen::Vector3d eye(1.0, 2.0, 3.0);
  EXPECT_EQ(mission.frame_poses.at(0).T_world_camera.translation, T_a_b * eye);
}

TEST(StationLayers, ThatAreDamagedAreFound) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1, 2});
  executeSql(path,
             "UPDATE layers SET data = CAST(substr(data, 1, 100) || x'00' || substr(data, 102) AS BLOB)"
             " WHERE mission = 2 AND x = -1 AND y = -1 AND z = -1");
  const Station station = Station::open(path);
  EXPECT_THAT(station.verify(), ElementsAre(HasSubstr("tile (-1, -1, -1) is damaged")));
  EXPECT_TRUE(station.loadLayer(0));
  EXPECT_THAT(test::messageOf<DataError>([&] { (void)station.loadLayer(1); }),
              HasSubstr("plant.tvx: tile (-1, -1, -1) is damaged"));
  (void)station.loadMap();  // which is sound
}

TEST(StationLayers, ThatAreLostAreFound) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1, 2});
  executeSql(path, "DELETE FROM layers WHERE mission = 1 AND x = 0 AND y = 0 AND z = 0");
  EXPECT_THAT(Station::open(path).verify(), ElementsAre(HasSubstr("is damaged, it holds")));
  EXPECT_THROW(Station::open(path).addMission(record("m3"), randomMission(3), KnownMission::refuse),
               DataError);
}

TEST(StationLayers, WithImpossibleErrorsAreRefused) {
  const TestFolder folder;
  const fs::path path = fullStation(folder, {1}, "plant.tvx");
  executeSql(path, "UPDATE missions SET shared_motions = x'0102'");
  EXPECT_THAT(test::messageOf<DataError>([&] { (void)Station::open(path).missions(); }),
              HasSubstr("plant.tvx: is damaged, mission 'm1': the shared errors of a mission have 2 bytes"));
}

}  // namespace
}  // namespace thermovox
