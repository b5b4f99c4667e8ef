#include "io/tile_codec.hpp"

#include <gtest/gtest.h>

#include <random>

#include "projection/error.hpp"
#include "tests/support/same_map.hpp"

namespace thermovox {
namespace {

constexpr TileKey kTile{-1, 0, -1};

TileBlocks blocksOf(const TileKey& tile) {
  const ThermalMap map = test::randomMission(1);
  TileBlocks blocks;
  for (const BlockKey& key : map.sortedBlockKeys()) {
    if (tileOf(key) == tile) blocks.emplace(key, *map.block(key));
  }
  return blocks;
}

TEST(TileCodec, RoundTripsBitForBit) {
  const TileBlocks blocks = blocksOf(kTile);
  ASSERT_GT(blocks.size(), 10U);
  const TileBlocks again = decodeTile(kTile, encodeTile(kTile, blocks));
  ASSERT_EQ(again.size(), blocks.size());
  for (const auto& [key, block] : blocks) {
    const Block& read = again.at(key);
    EXPECT_TRUE(read == block);
  }
}

TEST(TileCodec, WritesTheSameBytesTwice) {
  EXPECT_EQ(encodeTile(kTile, blocksOf(kTile)), encodeTile(kTile, blocksOf(kTile)));
}

TEST(TileCodec, RoundTripsAnEmptyTile) {
  EXPECT_TRUE(decodeTile(kTile, encodeTile(kTile, {})).empty());
}

TEST(TileCodec, NoticesEveryTruncation) {
  const std::string bytes = encodeTile(kTile, blocksOf(kTile));
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    EXPECT_THROW((void)decodeTile(kTile, bytes.substr(0, size)), DataError) << size;
  }
}

TEST(TileCodec, NoticesFlippedBits) {
  std::mt19937 rng(6);
  const std::string bytes = encodeTile(kTile, blocksOf(kTile));
  std::uniform_int_distribution<std::size_t> place(8, bytes.size() - 1);
  for (int i = 0; i < 200; ++i) {
    std::string damaged = bytes;
    damaged[place(rng)] ^= static_cast<char>(1 << (i % 8));
    EXPECT_THROW((void)decodeTile(kTile, damaged), DataError);
  }
}

TEST(TileCodec, RefusesOtherBytes) {
  EXPECT_THROW((void)decodeTile(kTile, ""), DataError);
  EXPECT_THROW((void)decodeTile(kTile, "not a tile at all"), DataError);
}

TEST(TileCodec, RefusesCellsThatContradictThemselves) {
  Block block;
  SurfaceCell& cell = block.surfaceOrNew(5);
  cell.addReturn({0.5, 0.5, 0.5});
  cell.addTemperature({20.0F, 0.1F, 1.0F, 0.0F}, Time{});
  const auto refuses = [&](const SurfaceCell& bad) {
    Block damaged = block;
    *damaged.surface(5) = bad;
    EXPECT_THROW((void)decodeTile({0, 0, 0}, encodeTile({0, 0, 0}, {{{0, 0, 0}, damaged}})), DataError);
  };
  SurfaceCell bad = cell;
  bad.max_code = 65535;
  refuses(bad);
  bad = cell;
  bad.weight_sum = 0;
  refuses(bad);
  bad = cell;
  bad.offset_sum[1] = 300;
  refuses(bad);
  bad = cell;
  bad.observations = 0;
  refuses(bad);
  bad = cell;
  bad.weighted_sum += std::uint64_t{1} << 60;
  refuses(bad);
}

}  // namespace
}  // namespace thermovox
