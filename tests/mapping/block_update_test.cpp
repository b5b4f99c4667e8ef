#include "mapping/block_update.hpp"

#include <gtest/gtest.h>

#include <random>

namespace thermovox {
namespace {

OccupancySteps stepsOf(const OccupancyModel& model) {
  return {.hit = static_cast<std::int8_t>(model.hit()),
          .miss = static_cast<std::int8_t>(model.miss()),
          .lowest = static_cast<std::int8_t>(model.clampMin()),
          .highest = static_cast<std::int8_t>(model.clampMax())};
}

CellBits randomBits(std::mt19937_64& rng, int thinned) {
  CellBits bits{};
  for (std::uint64_t& word : bits) {
    word = rng();
    for (int i = 0; i < thinned; ++i) word &= rng();
  }
  return bits;
}

TEST(UpdateLogOdds, IsTheOccupancyModelsUpdateAtEveryLevel) {
  const OccupancyModel model{OccupancyModel::Options{}};
  std::mt19937_64 rng(11);
  for (const CpuLevel level : {CpuLevel::baseline, CpuLevel::avx2, CpuLevel::avx512}) {
    if (level > cpuLevel()) continue;
    BlockLogOdds block;
    std::array<LogOdds, kBlockCells> expected;
    expected.fill(kUnknown);
    for (int reading = 0; reading < 60; ++reading) {
      const CellBits passed = randomBits(rng, reading % 3), hit = randomBits(rng, 2 + reading % 2);
      updateLogOdds(block.bytes(), passed, hit, stepsOf(model), level);
      for (int i = 0; i < kBlockCells; ++i) {
        const auto cell = static_cast<std::size_t>(i);
        const auto isSet = [&](const CellBits& bits) { return (bits[cell / 64] >> (cell % 64) & 1) != 0; };
        if (isSet(hit)) {
          expected[cell] = model.updated(expected[cell], model.hit());
        } else if (isSet(passed)) {
          expected[cell] = model.updated(expected[cell], model.miss());
        }
        ASSERT_EQ(block[i], expected[cell])
            << "reading " << reading << ", cell " << i << ", " << nameOf(level);
      }
    }
  }
}

TEST(UpdateLogOdds, MayCountACellAsUndecidedBeforeAHit) {
  OccupancySteps steps = stepsOf(OccupancyModel{OccupancyModel::Options{}});
  steps.before_hit = 0;
  const CellBits none{}, all{~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL};
  for (const CpuLevel level : {CpuLevel::baseline, CpuLevel::avx2, CpuLevel::avx512}) {
    if (level > cpuLevel()) continue;
    BlockLogOdds block;
    for (int i = 0; i < 10; ++i) updateLogOdds(block.bytes(), all, none, steps, level);
    EXPECT_EQ(block[77], steps.lowest);
    updateLogOdds(block.bytes(), none, all, steps, level);
    EXPECT_EQ(block[77], steps.hit);
    updateLogOdds(block.bytes(), none, all, steps, level);
    EXPECT_EQ(block[77], 2 * steps.hit);
  }
}

}  // namespace
}  // namespace thermovox
