#include "mapping/block_update.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "projection/error.hpp"

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

bool isSet(const CellBits& bits, int cell) {
  return (bits[static_cast<std::size_t>(cell) / 64] >> (cell % 64) & 1) != 0;
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
        if (isSet(hit, i)) {
          expected[cell] = model.updated(expected[cell], model.hit());
        } else if (isSet(passed, i)) {
          expected[cell] = model.updated(expected[cell], model.miss());
        }
        ASSERT_EQ(block[i], expected[cell])
            << "reading " << reading << ", cell " << i << ", " << nameOf(level);
      }
    }
  }
}

/// Anything an OccupancyModel takes, from nearly certain sensors to nearly useless ones.
OccupancyModel randomModel(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> more(0.5001, 0.9999), less(0.0001, 0.4999), share(0.0, 1.0);
  for (;;) {
    OccupancyModel::Options options{more(rng), less(rng), less(rng), more(rng), 0.5};
    options.occupied = options.clamp_min + share(rng) * (options.clamp_max - options.clamp_min);
    try {
      return OccupancyModel(options);
    } catch (const ConfigError&) {  // steps and clamps too far apart
    }
  }
}

TEST(UpdateLogOdds, IsTheUpdateOfAnyOccupancyModelAtEveryLevel) {
  std::mt19937_64 rng(12);
  for (int i = 0; i < 300; ++i) {
    const OccupancyModel model = randomModel(rng);
    const bool careful = i % 2 == 1;
    OccupancySteps steps = stepsOf(model);
    if (careful) steps.before_hit = 0;
    std::array<BlockLogOdds, 3> blocks;  // one a level
    std::array<LogOdds, kBlockCells> expected;
    expected.fill(kUnknown);
    for (int reading = 0; reading < 20; ++reading) {
      const CellBits passed = randomBits(rng, reading % 3), hit = randomBits(rng, reading % 4);
      for (int cell = 0; cell < kBlockCells; ++cell) {
        LogOdds& log_odds = expected[static_cast<std::size_t>(cell)];
        if (isSet(hit, cell)) {
          if (careful && log_odds != kUnknown) log_odds = std::max(log_odds, LogOdds{0});
          log_odds = model.updated(log_odds, model.hit());
        } else if (isSet(passed, cell)) {
          log_odds = model.updated(log_odds, model.miss());
        }
      }
      for (const CpuLevel level : {CpuLevel::baseline, CpuLevel::avx2, CpuLevel::avx512}) {
        if (level > cpuLevel()) continue;
        BlockLogOdds& block = blocks[static_cast<std::size_t>(level)];
        updateLogOdds(block.bytes(), passed, hit, steps, level);
        for (int cell = 0; cell < kBlockCells; ++cell) {
          ASSERT_EQ(block[cell], expected[static_cast<std::size_t>(cell)])
              << "model " << i << ", reading " << reading << ", cell " << cell << ", " << nameOf(level);
        }
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
