#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>

#include "mapping/cell_key.hpp"
#include "mapping/packed_integer.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// One temperature measured on a surface.
struct TemperatureObservation {
  float celsius = 0.0F;
  float sigma = 0.0F;      ///< one standard deviation, C; the camera's common bias is not in it
  float range = 0.0F;      ///< camera to point, metres
  float incidence = 0.0F;  ///< angle between the line of sight and the surface's normal, radians; NaN unknown
  /// Of the error that this and all other views at its angle have in common (GrazingView), one sigma, C,
  /// beside `sigma`: it does not shrink with their number.
  float common_sigma = 0.0F;
};

/// Throws DataError unless temperature and sigmas are finite.
void checkFinite(const TemperatureObservation& observation);

/// What a cell knows of the surface in it, in 58 bytes. All sums are integers in fixed point, so that adding
/// is exact and the result does not depend on the order (West's and Chan's updates would, in the last bits).
/// observations == 0 is the ONLY test for "no temperature": 0 C is one.
///
/// Units, and why nothing overflows: a temperature is taken within [-273.15, 3000] C and counted from -274 C
/// in 2^-9 C (2 mK, a tenth of what the best uncooled camera tells apart), so t < 2^20.68; a sigma is taken
/// within [0.02, 32] C and its weight 1 / sigma^2 counted in 2^-10 / C^2, so 1 <= w < 2^21.29. Over 2^22
/// observations w adds up to less than 2^43.3 (6 bytes), w t to less than 2^63.97 and w t^2 / 2^21 to less
/// than 2^63.7 (8 bytes each). What w t^2 is rounded by is at most 4 C^2 / w, 0.4 % of sigma^2, and without
/// bias.
///
/// An error that views at one angle have in common does not average out: of n such observations each is worth
/// 1 / (sigma^2 + n common_sigma^2). How many will come is not known when the first is weighed, and merging
/// must be exact; so n is kCommonViews. Hence one view without it stands against many that have it. It is
/// taken to the nearest c^2 / 2^11 C with c up to 255, and the cell keeps the least there was.
struct SurfaceCell {
  static constexpr double kMinCelsius = -273.15, kMaxCelsius = 3000.0;
  static constexpr double kOffsetSteps = 256.0;  ///< in an edge
  static constexpr double kMinSigma = 0.02, kMaxSigma = 32.0;
  static constexpr double kCommonViews = 16.0;
  /// Returns after which a cell's mean position stands still (its sums hold no more).
  static constexpr std::uint32_t kMaxReturns = (1U << 24) - 1;
  /// Observations after which its temperature does: five days without a pause at 9 Hz.
  static constexpr std::uint32_t kMaxObservations = 1U << 22;

  /// The view with the most pixels on the cell.
  struct View {
    float range;      ///< camera to point, metres, to the centimetre; 655.35 at most
    float incidence;  ///< radians, to 1/100; NaN unknown
  };

  PackedInteger<8> weighted_sum;         ///< of w t
  PackedInteger<8> weighted_square_sum;  ///< of w t^2 / 2^21
  PackedInteger<6> weight_sum;           ///< of w
  PackedInteger<6> last_code;            ///< stamp of the last temperature, in 2^15 ns (33 us)
  /// Sum over the returns of their place within the cell, in 1/256 of the cell's edge, rounded down.
  std::array<PackedInteger<4>, 3> offset_sum;
  PackedInteger<4> first_code;    ///< stamp of the first temperature, in 2^31 ns (2.1 s)
  PackedInteger<3> returns;       ///< laser returns that hit the cell; 0 where this mission only painted it
  PackedInteger<3> observations;  ///< temperatures
  PackedInteger<2> min_code;      ///< lowest temperature, in 1/16 C from -274 C
  PackedInteger<2> max_code;      ///< highest
  PackedInteger<2> best_range_cm;
  PackedInteger<1> best_incidence;  ///< 1/100 radians; kUnknownIncidence
  PackedInteger<1> common_code;     ///< least common sigma: 1 + the root of its steps of 2^-11 C; 0 unknown

  static constexpr std::uint8_t kUnknownIncidence = 0xFF;

  /// Adds a laser return at `offset` within the cell, in edges: [0, 1) on each axis, clamped to it.
  void addReturn(const Eigen::Vector3d& offset) {
    if (returns >= kMaxReturns) return;
    for (int i = 0; i < 3; ++i) {
      const double steps = std::min(std::max(offset[i] * kOffsetSteps, 0.0), kOffsetSteps - 1.0);
      offset_sum[static_cast<std::size_t>(i)] += static_cast<std::uint64_t>(steps);
    }
    returns += 1;
  }

  /// Adds one temperature with weight 1 / (sigma^2 + kCommonViews common_sigma^2), in the place of
  /// 1 / sigma^2 above, and Huber's guard against the cell's own statistics, which must be of the same
  /// mission: once four observations are in, one that is more than 2.5 standard deviations off the mean is
  /// weighted down in proportion, so that a passer-by or a glint does not move the cell. Hence this, unlike
  /// merge(), depends on the order. The standard deviation is that of the observation, of what it and the
  /// cell have in common with others, and of the cell's spread (at least 0.1 C) together. Throws DataError
  /// when the temperature or a sigma is not finite.
  void addTemperature(const TemperatureObservation& observation, Time stamp);

  /// Adds another mission's statistics of the same cell: exact, in any order and grouping, the mean position
  /// up to kMaxReturns returns and the mean temperature up to kMaxObservations. Where the two together hold
  /// more, nothing wraps: the sums of the one that counted more stand for both.
  void merge(const SurfaceCell& other);

  /// Whether the fields fit together, as they do in every cell that was built by the functions above: the
  /// counts and codes are possible, no sum is more than its count can give, the mean lies between the
  /// extremes, and no moment contradicts another. For cells that come from a file.
  [[nodiscard]] bool isPlausible() const;

  /// Mean place of the returns within the cell, in edges; its centre where no return was counted.
  [[nodiscard]] Eigen::Vector3d meanOffset() const;
  /// Weighted mean, C. Precondition for this and all below: observations > 0.
  [[nodiscard]] double mean() const;
  /// Standard deviation of the mean, C; the camera's common bias apart. With W the sum of the weights,
  /// n the observations, s their spread(), f the commonSigma() and m = kCommonViews:
  ///
  ///   sqrt(max(v / n, s^2 / n) + f^2 + b^2),  v = max(n / W - m f^2, 0),
  ///   b = (D - sqrt(D^2 - 4 e^2)) / 2,  D = max - min,  e^2 = max(s^2 - 4 v, 0).
  ///
  /// n / W is the mean variance that the weights stand for, m f^2 of it at least common, so that v is what is
  /// independent, and f^2 enters once: n alike have sigma^2 / n + f^2. Observations with more in common than
  /// f add some of that to v, which is more than they shift the mean by, because they weigh so little.
  /// v / n is what the observations' own sigmas promise; where they scatter more than that, s^2 / n widens it
  /// by their Birge ratio, as the Particle Data Group does (Review of Particle Physics, Introduction; there
  /// with n - 1). Both take the errors for independent. Once the spread is more than twice what the sigmas
  /// explain (e > 0), that is no longer to be believed: something else stood there for a while, or the cell
  /// holds two surfaces, and more observations do not bring the mean nearer to either. b is how far a mean
  /// lies from the larger of two populations that are D apart and spread it by e.
  [[nodiscard]] double sigmaOfMean() const;
  /// The least common sigma, C, of the observations whose angle is known: those of unknown angle may err as
  /// much. 0 where no angle is known.
  [[nodiscard]] double commonSigma() const;
  /// Weighted standard deviation of the observations about their mean, C.
  [[nodiscard]] double spread() const;
  [[nodiscard]] double minCelsius() const;  ///< to 1/32 C
  [[nodiscard]] double maxCelsius() const;  ///< to 1/32 C
  [[nodiscard]] Time first() const;         ///< at most 2.2 s early
  [[nodiscard]] Time last() const;          ///< at most 33 us early
  [[nodiscard]] View bestView() const;

  friend bool operator==(const SurfaceCell& a, const SurfaceCell& b) {
    return std::memcmp(&a, &b, sizeof(SurfaceCell)) == 0;
  }

 private:
  struct Sums {
    std::uint64_t observations, weight, weighted, square, common_code;
    friend auto operator<=>(const Sums&, const Sums&) = default;
  };
  struct Extremes {
    std::uint64_t min_code, max_code, first_code, last_code, range_cm, incidence;
  };
  void takeSums(const Sums& other);
  void takeExtremes(const Extremes& other);
  /// 1, or less for an observation that is far off.
  [[nodiscard]] double guardedShare(double celsius, double variance) const;
  [[nodiscard]] bool hasPlausibleTemperature() const;
  /// Weighted mean and mean of the squares, counted from -274 C.
  [[nodiscard]] double meanFromZero() const;
  [[nodiscard]] double meanSquare() const;
};
static_assert(sizeof(SurfaceCell) == 58 && alignof(SurfaceCell) == 1);

}  // namespace thermovox
