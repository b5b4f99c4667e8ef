#include "mapping/reading_marks.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace thermovox {
namespace {

/// The marked cells: 1 free, 2 hit, 3 both.
std::map<CellKey, int> marksOf(ReadingMarks& marks) {
  std::map<CellKey, int> cells;
  for (const ReadingMarks::Tile& tile : marks.sortedTiles()) {
    for (int index = 0; index < kBlockCells; ++index) {
      const auto bit = [&](const ReadingMarks::Bits& bits) {
        return static_cast<int>(bits[index / 64] >> (index % 64) & 1);
      };
      if (const int mark = bit(tile.free) + 2 * bit(tile.hit)) cells[cellAt(tile.key, index)] = mark;
    }
  }
  return cells;
}

TEST(ReadingMarks, AreThoseOfAPlainSetReadingAfterReading) {
  std::mt19937 rng(5);
  ReadingMarks marks;
  for (const int size : {10, 20000, 3, 50000, 1}) {
    std::uniform_int_distribution<int> cell(-200, 200);
    std::map<CellKey, int> expected;
    for (int i = 0; i < size; ++i) {
      const CellKey key{cell(rng), cell(rng), cell(rng)};
      if (i % 3 == 0) {
        marks.markHit(key);
        expected[key] |= 2;
      } else {
        marks.markFree(key);
        expected[key] |= 1;
      }
    }
    EXPECT_EQ(marksOf(marks), expected);
    marks.clear();
  }
}

TEST(ReadingMarks, ComeInTheOrderOfTheirBlocks) {
  ReadingMarks marks;
  for (const int x : {40, -40, 0, 80, -80}) marks.markHit({x, -x, x});
  const auto& tiles = marks.sortedTiles();
  ASSERT_EQ(tiles.size(), 5U);
  for (std::size_t i = 1; i < tiles.size(); ++i) EXPECT_LT(tiles[i - 1].key, tiles[i].key);
}

TEST(ReadingMarks, AreEmptyAtFirstAndAfterClear) {
  ReadingMarks marks;
  EXPECT_TRUE(marks.sortedTiles().empty());
  marks.clear();
  marks.markFree({1, 2, 3});
  EXPECT_EQ(marks.sortedTiles().size(), 1U);
  marks.clear();
  EXPECT_TRUE(marks.sortedTiles().empty());
}

}  // namespace
}  // namespace thermovox
