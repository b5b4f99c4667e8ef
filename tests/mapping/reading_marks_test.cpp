#include "mapping/reading_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace thermovox {
namespace {

enum Mark { kPassed = 1, kHit = 2, kBeside = 4 };

/// The marked cells; clears them, as whoever reads the marks does.
std::map<CellKey, int> takeMarks(ReadingMarks& marks) {
  std::map<CellKey, int> cells;
  const auto collect = [&](const TileKey& tile, int block, const CellBits& bits, int mark) {
    for (int i = 0; i < kBlockCells; ++i) {
      const std::uint64_t word = bits[static_cast<std::size_t>(i / 64)];
      if ((word >> (i % 64) & 1) != 0) cells[cellAt(blockAt(tile, block), i)] |= mark;
    }
  };
  for (ReadingMarks::Tile* tile : marks.tiles()) {
    for (int block = 0; block < kTileBlocks; ++block) {
      if (tile->passed) {
        CellBits passed{};
        std::copy_n(tile->passed->begin() + block * static_cast<int>(passed.size()), passed.size(),
                    passed.begin());
        collect(tile->key, block, passed, kPassed);
      }
      if (const CellBits* hit = tile->hit.find(block)) collect(tile->key, block, *hit, kHit);
      if (const CellBits* beside = tile->beside.find(block)) collect(tile->key, block, *beside, kBeside);
    }
    if (tile->passed) tile->passed->fill(0);
  }
  marks.clear();
  return cells;
}

TEST(ReadingMarks, AreThoseOfAPlainSetReadingAfterReading) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> coordinate(-30.0, 30.0);
  ReadingMarks marks;
  for (const int rays : {10, 300, 3, 500, 1}) {
    std::map<CellKey, int> expected;
    const Eigen::Vector3d origin(coordinate(rng), coordinate(rng), coordinate(rng));
    for (int i = 0; i < rays; ++i) {
      const Eigen::Vector3d end(coordinate(rng), coordinate(rng), coordinate(rng));
      const RayCells ray(origin, end, 0.1);
      marks.markHit(placeOf(ray.last()));
      expected[ray.last()] |= kHit;
      marks.markPassed(ray);
      ray.forEach([&](const CellKey& key) { expected[key] |= kPassed; });
    }
    std::map<CellKey, int> found = takeMarks(marks);
    for (auto& [key, mark] : found) {  // the last cell of a ray may be marked as passed too
      if ((mark & kHit) != 0) mark &= ~kPassed;
    }
    for (auto& [key, mark] : expected) {
      if ((mark & kHit) != 0) mark &= ~kPassed;
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(ReadingMarks, KeepAsMuchMemoryAsTheyMay) {
  ReadingMarks marks;
  for (int i = 0; i < 10; ++i) marks.markHit(placeOf({100 * i, 0, 0}));
  EXPECT_EQ(marks.memoryBytes(), 10 * sizeof(ReadingMarks::Tile));
  marks.keepAtMost(0);  // nothing that is marked goes
  EXPECT_EQ(takeMarks(marks).size(), 10U);
  const std::size_t of_tile = marks.memoryBytes() / 10;
  EXPECT_EQ(of_tile, sizeof(ReadingMarks::Tile) + sizeof(CellBits));  // one block of each was hit
  marks.keepAtMost(3 * of_tile + 1);
  EXPECT_EQ(marks.memoryBytes(), 3 * of_tile);
  for (int i = 0; i < 5; ++i) marks.markHit(placeOf({0, 100 * i, 0}));
  EXPECT_EQ(takeMarks(marks).size(), 5U);
}

TEST(ReadingMarks, KeepWhatIsAllocatedAndTenMegabytesAtMost) {
  ReadingMarks marks;
  const auto mark = [&marks](double length) {
    marks.markPassed(RayCells({0.05, 0.05, 0.05}, {length, 0.05, 0.05}, 0.1));
    (void)takeMarks(marks);
    return marks.memoryBytes();
  };
  const std::size_t of_tile = sizeof(ReadingMarks::Tile) + sizeof(ReadingMarks::Bits);
  EXPECT_EQ(mark(63.0), 10 * of_tile);
  EXPECT_EQ(mark(63.0), 10 * of_tile);
  EXPECT_EQ(mark(4000.05), ReadingMarks::kMostKept / of_tile * of_tile);
}

TEST(ReadingMarks, LieBesideAHitAcrossTheBordersOfTiles) {
  ReadingMarks marks;
  marks.markBeside({0, 63, -64});
  const std::map<CellKey, int> found = takeMarks(marks);
  EXPECT_EQ(found.size(), 6U);
  for (const CellKey key : {CellKey{-1, 63, -64}, CellKey{1, 63, -64}, CellKey{0, 62, -64},
                            CellKey{0, 64, -64}, CellKey{0, 63, -65}, CellKey{0, 63, -63}}) {
    EXPECT_TRUE(found.contains(key)) << key.x << " " << key.y << " " << key.z;
  }
}

TEST(ReadingMarks, WalkRaysThatAreTooLongForCodes) {
  ReadingMarks marks;
  const RayCells ray({0.05, 0.05, 0.05}, {4000.05, 0.05, 0.05}, 0.1);
  marks.markPassed(ray);
  EXPECT_EQ(takeMarks(marks).size(), 40000U);
}

TEST(ReadingMarks, TellTilesApartThatShareASlot) {
  ReadingMarks marks;
  for (const int x : {0, 16 * 64, -16 * 64, 32 * 64}) marks.markHit(placeOf({x, 0, 0}));
  for (const int x : {0, 16 * 64, -16 * 64, 32 * 64}) marks.markHit(placeOf({x, 1, 0}));
  EXPECT_EQ(marks.tiles().size(), 4U);
  EXPECT_EQ(takeMarks(marks).size(), 8U);
}

TEST(ReadingMarks, AreEmptyAtFirstAndAfterClear) {
  ReadingMarks marks;
  EXPECT_TRUE(marks.tiles().empty());
  EXPECT_EQ(marks.find({0, 0, 0}), nullptr);
  marks.markHit(placeOf({1, 2, 3}));
  EXPECT_NE(marks.find({0, 0, 0}), nullptr);
  EXPECT_EQ(takeMarks(marks).size(), 1U);
  EXPECT_TRUE(marks.tiles().empty());
  EXPECT_EQ(marks.find({0, 0, 0}), nullptr);
}

}  // namespace
}  // namespace thermovox
