#pragma once

#include <cstdint>
#include <limits>

namespace thermovox {

/// Log-odds of a cell in quanta of the map's OccupancyModel. One mission's own stay within +-127; over
/// missions they add up.
using LogOdds = std::int16_t;
/// Where no ray ever was.
inline constexpr LogOdds kUnknown = std::numeric_limits<LogOdds>::min();

/// OctoMap's occupancy update (Hornung et al. 2013, equations 2 to 4) in whole numbers: a hit adds one step,
/// a ray that passes takes another away, and within a mission the sum is clamped.
///
/// The quantum is chosen so that a hit is a whole number of quanta, a miss is one as nearly as possible, and
/// the clamping range, the hit and the miss fit +-127. OctoMap's defaults give ln(0.7 / 0.3) / 23 = 0.0368:
/// hit 23, miss 11.006, clamping at -54.3 and 95.3, both rounded. A cell's log-odds therefore differ from
/// OctoMap's by at most half a quantum since it was last clamped, and by missError() quanta more for every
/// miss since then.
class OccupancyModel {
 public:
  /// Probabilities; the defaults are OctoMap's.
  struct Options {
    double prob_hit = 0.7;      ///< of a cell that a return hit, 0.5 .. 1
    double prob_miss = 0.4;     ///< of a cell that a ray passed, 0 .. 0.5
    double clamp_min = 0.1192;  ///< no cell gets less certain to be occupied than this within a mission
    double clamp_max = 0.971;   ///< and none more
    double occupied = 0.5;      ///< from here on a cell counts as occupied
    /// Throws ConfigError naming the field and its value.
    void validate() const;
    friend bool operator==(const Options&, const Options&) = default;
  };

  /// Throws ConfigError when the options are invalid or no quantum can hold hit, miss and clamps together.
  explicit OccupancyModel(const Options& options);

  /// Natural log-odds of one quantum.
  [[nodiscard]] double quantum() const { return quantum_; }
  /// By how many quanta a miss is rounded, at most 0.5.
  [[nodiscard]] double missError() const { return miss_error_; }
  [[nodiscard]] int hit() const { return hit_; }
  /// Negative.
  [[nodiscard]] int miss() const { return miss_; }
  [[nodiscard]] int clampMin() const { return min_; }
  [[nodiscard]] int clampMax() const { return max_; }

  /// The log-odds after one more reading; `step` is hit() or miss().
  [[nodiscard]] LogOdds updated(LogOdds log_odds, int step) const {
    const int sum = (log_odds == kUnknown ? 0 : log_odds) + step;
    return static_cast<LogOdds>(sum < min_ ? min_ : (sum > max_ ? max_ : sum));
  }
  /// Natural log-odds of a known cell, clamped: sums over missions are clamped here, when they are read.
  [[nodiscard]] double naturalLogOdds(LogOdds log_odds) const {
    return quantum_ * (log_odds < min_ ? min_ : (log_odds > max_ ? max_ : log_odds));
  }
  /// Whether the log-odds reach Options::occupied, which is rounded up to a whole quantum: what is occupied
  /// here is so in OctoMap's trees and files, too.
  [[nodiscard]] bool isOccupied(LogOdds log_odds) const {
    return log_odds != kUnknown && log_odds >= occupied_;
  }

 private:
  double quantum_ = 0.0;
  double miss_error_ = 0.0;
  int hit_ = 0;
  int miss_ = 0;
  int min_ = 0;
  int max_ = 0;
  int occupied_ = 0;
};

/// Sum of two missions' log-odds; kUnknown adds nothing. Stops at +-32767, which takes 344 missions that all
/// saw the cell as surely as they could.
[[nodiscard]] LogOdds addedLogOdds(LogOdds a, LogOdds b);

}  // namespace thermovox
