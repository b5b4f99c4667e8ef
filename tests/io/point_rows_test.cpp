#include "io/point_rows.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

std::vector<PointRow> sorted(PointRows& rows) {
  std::vector<PointRow> result;
  rows.writeSorted(
      [&](std::span<const PointRow> some) { result.insert(result.end(), some.begin(), some.end()); });
  return result;
}

TEST(PointRows, ComeOutInTheOrderOfTheirStampsHoweverFewFitIntoMemory) {
  std::mt19937 rng(3);
  std::uniform_int_distribution<std::int64_t> stamp(-50, 5000);  // many are equal
  std::vector<PointRow> expected(10'000);
  for (std::size_t i = 0; i < expected.size(); ++i)
    expected[i] = {.stamp = stamp(rng), .range = static_cast<double>(i)};
  for (const std::size_t in_memory :
       {std::size_t{7}, std::size_t{3000}, std::size_t{10'000}, std::size_t{20'000}}) {
    SCOPED_TRACE(in_memory);
    const test::TestFolder folder;
    PointRows rows(folder / "points.csv", in_memory);
    for (const PointRow& row : expected) rows.add(row);
    EXPECT_EQ(rows.size(), expected.size());
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    const std::vector<PointRow> result = sorted(rows);
    ASSERT_EQ(result.size(), expected.size());
    for (std::size_t i = 1; i < result.size(); ++i) {
      ASSERT_LE(result[i - 1].stamp, result[i].stamp);
      if (result[i - 1].stamp == result[i].stamp) {
        ASSERT_LT(result[i - 1].range, result[i].range);
      }
    }
  }
}

TEST(PointRows, NoRowsAreNoRows) {
  const test::TestFolder folder;
  PointRows rows(folder / "points.csv");
  EXPECT_TRUE(sorted(rows).empty());
}

}  // namespace
}  // namespace thermovox
