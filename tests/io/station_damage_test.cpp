#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::executeSql;
using test::merged;
using test::namesIn;
using test::randomMission;
using test::record;
using test::refusal;
using test::sameMap;
using test::stationOf;
using test::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Station, RefusesWhatIsNoStation) {
  const TestFolder folder;
  EXPECT_THAT(refusal(folder / "nothing.tvx"), HasSubstr("nothing.tvx: does not exist"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a folder"));
  EXPECT_THAT(refusal(folder.write("empty.tvx", "")), HasSubstr("empty.tvx: is empty"));
  EXPECT_THAT(refusal(folder.write("text.tvx", std::string(5000, 'x'))),
              HasSubstr("text.tvx: is not a station"));
  executeSql(folder / "other.tvx", "CREATE TABLE t (a); INSERT INTO t VALUES (1)");
  EXPECT_THAT(refusal(folder / "other.tvx"), HasSubstr("other.tvx: is a SQLite database but not a station"));
}

TEST(Station, RefusesANewerVersion) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "PRAGMA user_version = 5");
  EXPECT_THAT(refusal(path), HasSubstr("written by a newer thermovox (station version 5)"));
}

TEST(Station, RefusesTruncatedFiles) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  const std::string bytes = test::bytesOf(path);
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.99}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    SCOPED_TRACE(size);
    EXPECT_THAT(refusal(folder.write("part.tvx", bytes.substr(0, size))), HasSubstr("part.tvx: "));
  }
}

TEST(Station, SaysWhichTileIsDamaged) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path,
             "UPDATE tiles SET data = CAST(substr(data, 1, 100) || x'00' || substr(data, 102) AS BLOB)"
             " WHERE x = -1 AND y = -1 AND z = -1");
  EXPECT_THAT(refusal(path), HasSubstr("plant.tvx: tile (-1, -1, -1) is damaged"));
  EXPECT_THAT(Station::open(path).verify(), ElementsAre(HasSubstr("tile (-1, -1, -1) is damaged")));
}

TEST(Station, IsNotContinuedWhereATileIsDamaged) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path,
             "UPDATE tiles SET data = CAST(substr(data, 1, 100) || x'00' || substr(data, 102) AS BLOB)"
             " WHERE x = -1 AND y = -1 AND z = -1");
  const std::string before = test::bytesOf(path);
  ThermalMap far(randomMission(0).options());  // which does not touch the tile
  const Eigen::Vector3d p_world(100.05, 100.05, 0.05);
  far.integrate({{{p_world, p_world, Time{}, std::nullopt}}}, Carving::none);
  EXPECT_THAT(test::messageOf<DataError>(
                  [&] { Station::open(path).addMission(record("far"), far, KnownMission::refuse); }),
              HasSubstr("plant.tvx: tile (-1, -1, -1) is damaged"));
  EXPECT_TRUE(test::bytesOf(path) == before);
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("plant.tvx"));
}

TEST(Station, RefusesTilesOutsideTheWorld) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "UPDATE tiles SET x = 2147483647 WHERE x = -1");
  EXPECT_THAT(refusal(path), HasSubstr("has a tile at 2147483647"));
}

TEST(Station, VerifiesItsCounts) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "UPDATE tiles SET surfaces = surfaces + 1 WHERE x = 0 AND y = 0 AND z = 0");
  EXPECT_THAT(Station::open(path).verify(),
              ElementsAre(HasSubstr("is damaged, it holds"), HasSubstr("than it says")));
}

TEST(Station, NoticesLostTilesAndMissions) {
  const TestFolder folder;
  for (const char* loss : {"DELETE FROM tiles WHERE x = -1 AND y = -1 AND z = -1", "DELETE FROM tiles",
                           "DELETE FROM missions WHERE id = 2"}) {
    SCOPED_TRACE(loss);
    const fs::path path = stationOf(folder, {1, 2});
    executeSql(path, loss);
    Station station = Station::open(path);
    EXPECT_THAT(station.verify(), ElementsAre(HasSubstr("plant.tvx: is damaged, it holds")));
    // A further mission must not make the loss look right.
    EXPECT_THROW(station.addMission(record("m3"), randomMission(3), KnownMission::refuse), DataError);
    fs::remove(path);
  }
}

TEST(Station, RefusesMetaThatIsGone) {
  const TestFolder folder;
  const fs::path path = stationOf(folder, {1});
  executeSql(path, "DELETE FROM meta WHERE key = 'resolution'");
  EXPECT_THAT(refusal(path), HasSubstr("no number for resolution"));
}

}  // namespace
}  // namespace thermovox
