#include "mapping/block.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace thermovox {
namespace {

TEST(BlockLogOdds, TakeTwoBytesOnceOneIsTooSmall) {
  BlockLogOdds block;
  EXPECT_EQ(block[3], kUnknown);
  block.set(3, -127);
  block.set(4, 127);
  EXPECT_TRUE(block.isNarrow());
  block.set(5, 128);
  EXPECT_FALSE(block.isNarrow());
  EXPECT_EQ(block[3], -127);
  EXPECT_EQ(block[4], 127);
  EXPECT_EQ(block[5], 128);
  EXPECT_EQ(block[6], kUnknown);
  EXPECT_EQ(block.knownCells(), 3U);
}

TEST(BlockLogOdds, AreEqualByTheirValuesHoweverWideTheyAre) {
  BlockLogOdds narrow, wide;
  wide.set(0, 300);
  wide.set(0, 7);
  narrow.set(0, 7);
  EXPECT_FALSE(wide.isNarrow());
  EXPECT_EQ(narrow, wide);
  wide.set(1, 1);
  EXPECT_NE(narrow, wide);
}

TEST(BlockLogOdds, AddInAnyOrder) {
  std::mt19937 rng(2);
  std::uniform_int_distribution<int> quanta(-54, 95), known(0, 2);
  const auto random = [&] {
    BlockLogOdds block;
    for (int i = 0; i < kBlockCells; ++i) {
      if (known(rng) != 0) block.set(i, static_cast<LogOdds>(quanta(rng)));
    }
    return block;
  };
  const BlockLogOdds missions[] = {random(), random(), random()};
  BlockLogOdds forth, back;
  for (int i = 0; i < 3; ++i) {
    forth.add(missions[i]);
    back.add(missions[2 - i]);
  }
  EXPECT_EQ(forth, back);
  BlockLogOdds copy = forth;
  EXPECT_EQ(copy, forth);
  copy = missions[0];
  EXPECT_EQ(copy, missions[0]);
}

TEST(Block, FindsTheSurfacesOfItsCellsHoweverTheyCame) {
  std::mt19937 rng(1);
  std::uniform_int_distribution<int> cell(0, kBlockCells - 1);
  Block block;
  std::map<int, std::uint64_t> returns;
  for (int i = 0; i < 2000; ++i) {
    const int index = cell(rng);
    block.surfaceOrNew(index).addReturn({0.5, 0.5, 0.5});
    ++returns[index];
  }
  EXPECT_EQ(block.surfaceCount(), returns.size());
  for (int i = 0; i < kBlockCells; ++i) {
    const SurfaceCell* surface = block.surface(i);
    ASSERT_EQ(surface != nullptr, returns.contains(i));
    if (surface != nullptr) {
      EXPECT_EQ(surface->returns, returns[i]);
    }
  }
  std::vector<int> visited;
  block.forEachSurface([&](int index, const SurfaceCell&) { visited.push_back(index); });
  EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
  EXPECT_EQ(visited.size(), returns.size());
}

TEST(Block, KeepsLittleRoomInReserve) {
  Block block;
  for (int i = 0; i < 64; ++i) block.surfaceOrNew(i).addReturn({0.5, 0.5, 0.5});
  EXPECT_LE(block.memoryBytes() - Block().memoryBytes(), 64U * 64U);
}

}  // namespace
}  // namespace thermovox
