#include "mapping/occupancy_model.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kLargestQuanta = 127.0;
constexpr double kRounding = 1e-9;  // quanta; a threshold of exactly so many steps is not rounded up

double logOddsOf(double probability) {
  return std::log(probability / (1.0 - probability));
}

void require(bool valid, const char* field, double value, const char* expected) {
  if (valid) return;
  std::ostringstream message;
  message << "occupancy." << field << " is " << value << ", expected " << expected;
  throw ConfigError(message.str());
}

/// Whole numbers of quanta for a hit and a miss, and how far the miss was from being one.
struct Steps {
  int hit = 0;
  int miss = 0;
  double miss_error = 1.0;
};

/// Tries every count for a hit with which the clamps still fit, and takes the one whose miss is rounded least
/// in proportion; on a tie the finer.
Steps bestSteps(double hit, double miss, double widest) {
  Steps best;
  double least = 1.0;
  const int most = std::min(static_cast<int>(std::floor(kLargestQuanta * hit / widest)), 1 << 12);
  for (int count = 1; count <= most; ++count) {
    const double exact = miss * count / hit;
    const int rounded = static_cast<int>(std::lround(exact));
    if (rounded < 1) continue;
    const double error = std::abs(exact - rounded);
    if (error / exact > least) continue;
    least = error / exact;
    best = {count, rounded, error};
  }
  return best;
}

}  // namespace

void OccupancyModel::Options::validate() const {
  require(prob_hit > 0.5 && prob_hit < 1.0, "prob_hit", prob_hit, "more than 0.5 and less than 1");
  require(prob_miss > 0.0 && prob_miss < 0.5, "prob_miss", prob_miss, "more than 0 and less than 0.5");
  require(clamp_min > 0.0 && clamp_min < 0.5, "clamp_min", clamp_min, "more than 0 and less than 0.5");
  require(clamp_max > 0.5 && clamp_max < 1.0, "clamp_max", clamp_max, "more than 0.5 and less than 1");
  require(occupied > clamp_min && occupied < clamp_max, "occupied", occupied, "a value between the clamps");
}

OccupancyModel::OccupancyModel(const Options& options) {
  options.validate();
  const double hit = logOddsOf(options.prob_hit);
  const double miss = -logOddsOf(options.prob_miss);
  const double lowest = logOddsOf(options.clamp_min);
  const double highest = logOddsOf(options.clamp_max);
  const Steps steps = bestSteps(hit, miss, std::max({-lowest, highest, hit, miss}));
  if (steps.hit == 0) {
    throw ConfigError(
        "occupancy: prob_hit, prob_miss and the clamps are too far apart to share one step of "
        "log-odds; expected a miss of at least 1/127 of the wider clamp");
  }
  quantum_ = hit / steps.hit;
  miss_error_ = steps.miss_error;
  hit_ = steps.hit;
  miss_ = -steps.miss;
  min_ = static_cast<int>(std::lround(lowest / quantum_));
  max_ = static_cast<int>(std::lround(highest / quantum_));
  // Up, so that no cell is occupied here and free to OctoMap, which compares the log-odds themselves.
  occupied_ = static_cast<int>(std::ceil(logOddsOf(options.occupied) / quantum_ - kRounding));
  require(occupied_ <= max_, "occupied", options.occupied, "at least one step of log-odds below clamp_max");
}

LogOdds addedLogOdds(LogOdds a, LogOdds b) {
  if (a == kUnknown) return b;
  if (b == kUnknown) return a;
  constexpr int most = std::numeric_limits<LogOdds>::max();
  return static_cast<LogOdds>(std::clamp(a + b, -most, most));
}

}  // namespace thermovox
