#include "io/spilled_tiles.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "io/station.hpp"
#include "io/station_tiles.hpp"
#include "projection/error.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

using test::randomMission;
using test::TestFolder;

/// Puts all tiles of the map into the store.
void spill(const ThermalMap& map, TileStore& store) {
  MapTiles tiles(map);
  while (const auto key = tiles.key()) store.put(*key, viewsOf(*key, *tiles.next().tile));
}

ThermalMap unspilled(TileStore& store, const ThermalMap::Options& options) {
  ThermalMap map(options);
  for (const TileKey& tile : store.sortedTiles()) {
    auto blocks = store.take(tile);
    for (auto& [key, block] : *blocks) map.setBlock(key, std::move(block));
  }
  return map;
}

TEST(SpilledTiles, GiveBackWhatWasPut) {
  const TestFolder folder;
  const ThermalMap map = randomMission(1);
  SpilledTiles store(folder.path());
  spill(map, store);
  EXPECT_GE(store.sortedTiles().size(), 8U);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));  // its file has no name
  EXPECT_TRUE(test::sameMap(unspilled(store, map.options()), map));
  EXPECT_TRUE(store.sortedTiles().empty());
}

TEST(SpilledTiles, AreSavedFromWhereTheyAre) {
  const TestFolder folder;
  const ThermalMap whole = randomMission(1);
  ThermalMap spilled(whole.options());
  SpilledTiles store(folder.path());
  spilled.spillTo(store, 1);
  for (const BlockKey& key : whole.sortedBlockKeys()) spilled.setBlock(key, *whole.block(key));
  const std::vector<TileKey> before = store.sortedTiles();
  ASSERT_GE(before.size(), 7U);
  Station::create(folder / "whole.tvx", whole.options()).addMission({}, whole, KnownMission::refuse);
  Station::create(folder / "spilled.tvx", whole.options()).addMission({}, spilled, KnownMission::refuse);
  EXPECT_EQ(test::bytesOf(folder / "spilled.tvx"), test::bytesOf(folder / "whole.tvx"));
  EXPECT_EQ(store.sortedTiles(), before);  // none came back into memory
  ThermalMap again(whole.options());
  SpilledTiles another(folder.path());
  again.spillTo(another, 1);
  Station::open(folder / "whole.tvx").loadInto(again);
  EXPECT_GE(another.sortedTiles().size(), 7U);
  EXPECT_TRUE(test::sameMap(again, whole));
}

TEST(SpilledTiles, ForgetWhatIsTakenAndKeepWhatIsRead) {
  const TestFolder folder;
  SpilledTiles store(folder.path());
  spill(randomMission(1), store);
  const TileKey tile{-1, 0, -1};
  ASSERT_TRUE(store.holds(tile));
  EXPECT_EQ(store.get(tile), store.get(tile));
  EXPECT_TRUE(store.take(tile));
  EXPECT_FALSE(store.holds(tile));
  EXPECT_FALSE(store.get(tile));
  EXPECT_FALSE(store.take(tile));
}

TEST(SpilledTiles, UseTheRoomOfTilesThatWereReplacedOrTaken) {
  const TestFolder folder;
  const ThermalMap map = randomMission(1);
  SpilledTiles store(folder.path());
  spill(map, store);
  spill(map, store);  // beside the old ones, which are kept until the new ones are written
  const std::uint64_t size = store.fileSize();
  for (int i = 0; i < 10; ++i) spill(map, store);
  EXPECT_LE(store.fileSize(), size);
  EXPECT_TRUE(test::sameMap(unspilled(store, map.options()), map));
}

TEST(SpilledTiles, SayThatTheDiskIsFull) {
  const TestFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{8192, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    SpilledTiles store(folder.path());
    const std::string message = test::messageOf<DataError>([&] {
      for (unsigned seed = 0; seed < 100; ++seed) spill(randomMission(seed), store);
    });
    _exit(message.find("the disk is full") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(SpilledTiles, NameAFolderThatIsNotThere) {
  const TestFolder folder;
  SpilledTiles store(folder / "nowhere");
  EXPECT_THAT(test::messageOf<DataError>([&] { spill(randomMission(1), store); }),
              testing::HasSubstr("nowhere: tiles that do not fit into memory cannot be kept here"));
}

}  // namespace
}  // namespace thermovox
