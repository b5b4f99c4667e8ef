#include "mapping/sparse_tile_bits.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace thermovox {
namespace {

std::set<std::uint32_t> cellsOf(const SparseTileBits& bits) {
  std::set<std::uint32_t> cells;
  for (int block = 0; block < kTileBlocks; ++block) {
    const CellBits* line = bits.find(block);
    EXPECT_EQ(line != nullptr,
              (bits.blocks()[static_cast<std::size_t>(block / 64)] >> (block % 64) & 1) != 0);
    for (int i = 0; line != nullptr && i < kBlockCells; ++i) {
      if (((*line)[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1) != 0) {
        cells.insert(static_cast<std::uint32_t>(block * kBlockCells + i));
      }
    }
  }
  return cells;
}

TEST(SparseTileBits, HoldWhatWasSetAndNothingElseAlsoAfterClear) {
  std::mt19937 rng(7);
  SparseTileBits bits;
  for (const int count : {0, 1, 40, 3000, 0, 2}) {
    std::set<std::uint32_t> expected;
    for (int i = 0; i < count; ++i) {
      const auto cell = static_cast<std::uint32_t>(rng() % (kTileBlocks * kBlockCells));
      bits.set(cell);
      expected.insert(cell);
    }
    EXPECT_EQ(cellsOf(bits), expected);
    bits.clear();
  }
}

TEST(SparseTileBits, ReachTheFirstAndTheLastCell) {
  SparseTileBits bits;
  bits.set(0);
  bits.set(kTileBlocks * kBlockCells - 1);
  EXPECT_EQ(cellsOf(bits), (std::set<std::uint32_t>{0, kTileBlocks * kBlockCells - 1}));
}

}  // namespace
}  // namespace thermovox
