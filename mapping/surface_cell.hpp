#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "mapping/cell_key.hpp"
#include "mapping/sum96.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// One temperature measured on a surface.
struct TemperatureObservation {
  float celsius = 0.0F;
  float sigma = 0.0F;      ///< one standard deviation, C; the camera's common bias is not in it
  float range = 0.0F;      ///< camera to point, metres
  float incidence = 0.0F;  ///< angle between the line of sight and the surface's normal, radians; NaN unknown
};

/// What a cell knows of the surface in it. All sums are integers in fixed point, so that adding is exact and
/// the result does not depend on the order (West's and Chan's updates would, in the last bits).
/// observations == 0 is the ONLY test for "no temperature": 0 C is one.
///
/// Units, and why nothing overflows: a temperature is taken within [-273.15, 3000] C and counted from -274 C
/// in 2^-16 C, so t < 2^27.7; a sigma is taken within [0.01, 100] C and its weight 1 / sigma^2 counted in
/// 2^-18 / C^2, so w <= 10^4 * 2^18 < 2^31.3. Over 2^32 observations w adds up to less than 2^63.3 (64 bits),
/// w t to less than 2^91 (96 bits) and w t^2 / 2^24 to less than 2^94.7 (96 bits). The bits that w t^2 loses
/// are worth at most 2^-8 C^2 / w: 1e-4 C^2 where sigma is 100 C, 1e-12 where it is 0.01.
struct SurfaceCell {
  static constexpr double kMinCelsius = -273.15, kMaxCelsius = 3000.0;
  static constexpr double kMinSigma = 0.01, kMaxSigma = 100.0;
  /// Returns after which a cell's mean position stands still (its sums hold no more).
  static constexpr std::uint32_t kMaxReturns = 1U << 24;

  /// The view with the most pixels on the cell.
  struct View {
    float range;      ///< camera to point, metres, to the centimetre; 655.35 at most
    float incidence;  ///< radians, to 1e-4; NaN unknown
  };

  std::uint64_t weight_sum = 0;  ///< of w
  std::int64_t first_ns = 0;     ///< stamp of the first temperature
  std::int64_t last_ns = 0;      ///< and of the last
  Sum96 weighted_sum;            ///< of w t
  Sum96 weighted_square_sum;     ///< of w t^2 / 2^24
  /// Sum over the returns of their place within the cell, in 1/256 of the cell's edge, rounded down.
  std::array<std::uint32_t, 3> offset_sum{};
  std::uint32_t returns = 0;       ///< laser returns that hit the cell
  std::uint32_t observations = 0;  ///< temperatures
  float min_celsius = 0.0F;
  float max_celsius = 0.0F;
  std::uint16_t best_range_cm = 0;
  std::uint16_t best_incidence = 0;  ///< 1e-4 radians; kUnknownIncidence

  static constexpr std::uint16_t kUnknownIncidence = 0xFFFF;

  /// Adds a laser return at `offset` within the cell, in edges: [0, 1) on each axis, clamped to it.
  void addReturn(const Eigen::Vector3d& offset);

  /// Adds one temperature with weight 1 / sigma^2 and Huber's guard against the cell's own statistics, which
  /// must be of the same mission: once four observations are in, one that is more than 2.5 standard
  /// deviations off the mean is weighted down in proportion, so that a passer-by or a glint does not move the
  /// cell. Hence this, unlike merge(), depends on the order. The standard deviation is that of the
  /// observation and of the cell's spread (at least 0.1 C) together. Throws DataError when the temperature or
  /// its sigma is not finite.
  void addTemperature(const TemperatureObservation& observation, Time stamp);

  /// Adds another mission's statistics of the same cell: exact, in any order and grouping, the mean position
  /// up to kMaxReturns returns and the mean temperature up to 2^32 - 1 observations. Where the two together
  /// hold more, nothing wraps: the sums of the one that counted more stand for both.
  void merge(const SurfaceCell& other);

  /// Whether the fields fit together, as they do in every cell that a return hit and that was built by the
  /// functions above: the counts and codes are possible, no sum is more than its count can give, the mean
  /// lies between the extremes, and no moment contradicts another. For cells that come from a file.
  [[nodiscard]] bool isPlausible() const;

  /// Mean place of the returns within the cell, in edges. Precondition: returns > 0.
  [[nodiscard]] Eigen::Vector3d meanOffset() const;
  /// Weighted mean, C. Precondition for this and all below: observations > 0.
  [[nodiscard]] double mean() const;
  /// Standard deviation of the mean, C; the camera's common bias apart. With W the sum of the weights
  /// 1 / sigma^2, n the observations and s their spread():
  ///
  ///   sqrt(max(1 / W, s^2 / n) + b^2),  b = (D - sqrt(D^2 - 4 e^2)) / 2,  D = max - min,
  ///   e^2 = max(s^2 - 4 n / W, 0).
  ///
  /// 1 / W is what the observations' own sigmas promise; where they scatter more than that, s^2 / n widens it
  /// by their Birge ratio, as the Particle Data Group does (Review of Particle Physics, Introduction; there
  /// with n - 1). Both take the errors for independent. Once the spread is more than twice what the sigmas
  /// explain (e > 0), that is no longer to be believed: something else stood there for a while, or the cell
  /// holds two surfaces, and more observations do not bring the mean nearer to either. b is how far a mean
  /// lies from the larger of two populations that are D apart and spread it by e.
  [[nodiscard]] double sigmaOfMean() const;
  /// Weighted standard deviation of the observations about their mean, C.
  [[nodiscard]] double spread() const;
  [[nodiscard]] Time first() const { return Time(Duration(first_ns)); }
  [[nodiscard]] Time last() const { return Time(Duration(last_ns)); }
  [[nodiscard]] View bestView() const;

  friend bool operator==(const SurfaceCell&, const SurfaceCell&) = default;

 private:
  /// Observations, weights and moments; of two too many for one cell the busier one's.
  void addSums(const SurfaceCell& other);
  [[nodiscard]] bool hasPlausibleTemperature() const;
  /// Weighted mean of the squares, counted from -274 C.
  [[nodiscard]] double meanSquare() const;
};
static_assert(sizeof(SurfaceCell) == 80);

}  // namespace thermovox
