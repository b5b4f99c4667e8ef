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
  const TileBlocks again = decodeTile(kTile, encodeTile(blocks));
  ASSERT_EQ(again.size(), blocks.size());
  for (const auto& [key, block] : blocks) {
    const Block& read = again.at(key);
    EXPECT_TRUE(read == block);
  }
}

TEST(TileCodec, WritesTheSameBytesTwice) {
  EXPECT_EQ(encodeTile(blocksOf(kTile)), encodeTile(blocksOf(kTile)));
}

TEST(TileCodec, RoundTripsAnEmptyTile) {
  EXPECT_TRUE(decodeTile(kTile, encodeTile(TileBlocks{})).empty());
}

TEST(TileCodec, NoticesEveryTruncation) {
  const std::string bytes = encodeTile(blocksOf(kTile));
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    EXPECT_THROW((void)decodeTile(kTile, bytes.substr(0, size)), DataError) << size;
  }
}

// A few bits of a zstd frame carry nothing: what is read in spite of a flip must be what was written.
TEST(TileCodec, NoticesFlippedBits) {
  std::mt19937 rng(6);
  const TileBlocks blocks = blocksOf(kTile);
  const std::string bytes = encodeTile(blocks);
  std::uniform_int_distribution<std::size_t> place(8, bytes.size() - 1);
  int noticed = 0;
  for (int i = 0; i < 200; ++i) {
    std::string damaged = bytes;
    damaged[place(rng)] ^= static_cast<char>(1 << (i % 8));
    try {
      EXPECT_EQ(decodeTile(kTile, damaged), blocks);
    } catch (const DataError&) {
      ++noticed;
    }
  }
  EXPECT_GT(noticed, 190);
}

TEST(TileCodec, TellsNothingOfHowSumsOverMissionsAreKept) {
  Block block;
  block.log_odds.set(3, 100);
  Block other = block;
  other.merge(block);  // 200 takes two bytes
  Block back;
  back.log_odds.set(3, -100);
  other.merge(back);
  ASSERT_FALSE(other.log_odds.isNarrow());
  const BlockKey key{0, 0, 0};
  EXPECT_EQ(encodeTile(TileBlocks{{key, block}}), encodeTile(TileBlocks{{key, other}}));
}

TEST(TileCodec, KeepsSumsThatTakeTwoBytes) {
  Block block;
  block.log_odds.set(0, 32767);
  block.log_odds.set(511, -32767);
  const TileBlocks blocks{{{0, 0, 0}, block}};
  EXPECT_EQ(decodeTile({0, 0, 0}, encodeTile(blocks)), blocks);
}

TEST(TileCodec, KeepsTheCommonSigma) {
  Block block;
  block.surfaceOrNew(7).addTemperature(
      {.celsius = 20.0F, .sigma = 0.1F, .range = 1.0F, .incidence = 1.2F, .common_sigma = 3.0F}, Time{});
  const TileBlocks blocks{{{0, 0, 0}, block}};
  EXPECT_NEAR(decodeTile({0, 0, 0}, encodeTile(blocks)).begin()->second.surface(7)->commonSigma(), 3.0, 0.05);
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
    EXPECT_THROW((void)decodeTile({0, 0, 0}, encodeTile(TileBlocks{{{0, 0, 0}, damaged}})), DataError);
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
