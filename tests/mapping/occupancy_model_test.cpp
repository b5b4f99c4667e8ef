#include "mapping/occupancy_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using testing::HasSubstr;

TEST(OccupancyModel, CountsOctomapsDefaultsInWholeNumbers) {
  const OccupancyModel model({});
  EXPECT_NEAR(model.quantum(), std::log(0.7 / 0.3) / 23, 1e-15);
  EXPECT_EQ(model.hit(), 23);
  EXPECT_EQ(model.miss(), -11);
  EXPECT_NEAR(model.missError(), 0.0063, 1e-4);
  EXPECT_EQ(model.clampMin(), -54);
  EXPECT_EQ(model.clampMax(), 95);
}

TEST(OccupancyModel, KeepsMissAndClampsWithinTheirBoundsForAnyOptions) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> hit(0.55, 0.95), miss(0.001, 0.45), low(0.02, 0.3), high(0.7, 0.99);
  for (int i = 0; i < 1000; ++i) {
    const OccupancyModel::Options options{hit(rng), miss(rng), low(rng), high(rng), 0.5};
    const OccupancyModel model(options);
    SCOPED_TRACE(testing::Message() << options.prob_hit << ' ' << options.prob_miss);
    EXPECT_LE(model.clampMax(), 127);
    EXPECT_GE(model.clampMin(), -127);
    EXPECT_GE(model.hit(), 1);
    EXPECT_LE(model.hit(), 127);
    EXPECT_LE(model.miss(), -1);
    EXPECT_GE(model.miss(), -127);
    EXPECT_LE(model.missError(), 0.5);
    EXPECT_NEAR(model.miss() * model.quantum(), std::log(options.prob_miss / (1 - options.prob_miss)),
                model.missError() * model.quantum() + 1e-12);
  }
}

TEST(OccupancyModel, ClampsWithinAMissionAndWhenItReads) {
  const OccupancyModel model({});
  LogOdds log_odds = kUnknown;
  for (int i = 0; i < 100; ++i) log_odds = model.updated(log_odds, model.hit());
  EXPECT_EQ(log_odds, model.clampMax());
  for (int i = 0; i < 100; ++i) log_odds = model.updated(log_odds, model.miss());
  EXPECT_EQ(log_odds, model.clampMin());
  EXPECT_EQ(model.naturalLogOdds(300), model.naturalLogOdds(static_cast<LogOdds>(model.clampMax())));
}

TEST(OccupancyModel, TellsUnknownFromFree) {
  const OccupancyModel model({});
  EXPECT_FALSE(model.isOccupied(kUnknown));
  EXPECT_TRUE(model.isOccupied(0));
  EXPECT_FALSE(model.isOccupied(-1));
}

TEST(OccupancyModel, TakesForOccupiedOnlyWhatReachesTheThreshold) {
  for (int i = 15; i <= 95; ++i) {
    const double occupied = 0.01 * i;
    const OccupancyModel model({.occupied = occupied});
    const double threshold = std::log(occupied / (1.0 - occupied));
    for (int quanta = model.clampMin(); quanta <= model.clampMax(); ++quanta) {
      const auto log_odds = static_cast<LogOdds>(quanta);
      EXPECT_EQ(model.isOccupied(log_odds), model.naturalLogOdds(log_odds) >= threshold - 1e-9)
          << quanta << " quanta, threshold " << occupied;
    }
  }
  EXPECT_TRUE(OccupancyModel({.occupied = 0.7}).isOccupied(23));  // exactly one hit, so one hit will do
}

TEST(OccupancyModel, AddsMissionsWithoutTheUnknown) {
  EXPECT_EQ(addedLogOdds(kUnknown, kUnknown), kUnknown);
  EXPECT_EQ(addedLogOdds(kUnknown, -11), -11);
  EXPECT_EQ(addedLogOdds(95, kUnknown), 95);
  EXPECT_EQ(addedLogOdds(95, 95), 190);
  EXPECT_EQ(addedLogOdds(32000, 32000), 32767);
  EXPECT_EQ(addedLogOdds(-32000, -32000), -32767);
}

TEST(OccupancyModel, RefusesOptionsByName) {
  const auto message = [](const OccupancyModel::Options& options) {
    return test::messageOf<ConfigError>([&] { const OccupancyModel model(options); });
  };
  EXPECT_THAT(message({.prob_hit = 0.4}), HasSubstr("occupancy.prob_hit is 0.4"));
  EXPECT_THAT(message({.prob_miss = 0.6}), HasSubstr("occupancy.prob_miss is 0.6"));
  EXPECT_THAT(message({.clamp_min = 0.0}), HasSubstr("occupancy.clamp_min is 0"));
  EXPECT_THAT(message({.clamp_max = std::nan("")}), HasSubstr("occupancy.clamp_max is nan"));
  EXPECT_THAT(message({.occupied = 0.99}), HasSubstr("occupancy.occupied is 0.99"));
  EXPECT_THAT(message({.occupied = 0.9709}), HasSubstr("one step of log-odds below clamp_max"));
  EXPECT_THAT(message({.prob_hit = 0.55, .prob_miss = 0.4999}), HasSubstr("too far apart"));
}

}  // namespace
}  // namespace thermovox
