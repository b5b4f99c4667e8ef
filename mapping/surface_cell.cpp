#include "mapping/surface_cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kZeroCelsius = -274.0;      // where temperatures count from: whole, so that 0 C is exact
constexpr double kTemperatureSteps = 512.0;  // a degree
constexpr double kWeightSteps = 1024.0;      // 1 / C^2
constexpr int kSquareShift = 21;
constexpr double kSquareSteps = kTemperatureSteps * kTemperatureSteps / (1 << kSquareShift);
constexpr double kExtremeSteps = 16.0;         // a degree
constexpr std::uint32_t kGuardAfter = 4;       // observations that pass unguarded
constexpr double kGuardSigmas = 2.5;           // loses 1.6 % of efficiency on clean Gaussian data
constexpr double kGuardFloor = 0.1;            // C; two frames of a camera agree no better
constexpr double kExplainedSpread = 2.0;       // as a multiple of what the sigmas promise
constexpr double kRangeSteps = 100.0;          // a metre
constexpr double kIncidenceSteps = 100.0;      // a radian
constexpr std::uint64_t kMostIncidence = 157;  // a right angle
constexpr double kUnknownCosine = 0.5;         // an unknown incidence counts as 60 degrees
constexpr std::int64_t kFirstStamp = -(std::int64_t{1} << 62);  // stamps lie within +-2^62 ns of 1970
constexpr double kCommonSteps = 2048.0;                         // a degree, under the root
constexpr double kMostCommon = 254.0;
constexpr int kLastShift = 15, kFirstShift = 31;

/// Nanoseconds from kFirstStamp, at most 2^63 - 1.
std::uint64_t stampFromZero(Time stamp) {
  const std::int64_t ns = std::clamp(stamp.time_since_epoch().count(), kFirstStamp, -kFirstStamp - 1);
  return static_cast<std::uint64_t>(ns - kFirstStamp);
}
Time stampOf(std::uint64_t code, int shift) {
  return Time(Duration(static_cast<std::int64_t>(code << shift) + kFirstStamp));
}

std::uint64_t extremeCode(double celsius) {
  return static_cast<std::uint64_t>((celsius - kZeroCelsius) * kExtremeSteps + 0.5);
}
double extremeOf(std::uint64_t code) {
  return static_cast<double>(code) / kExtremeSteps + kZeroCelsius;
}

std::uint16_t rangeCode(float range) {
  return static_cast<std::uint16_t>(range >= 0.0F ? std::min(range * kRangeSteps + 0.5, 65535.0) : 65535.0);
}

std::uint8_t incidenceCode(float incidence) {
  if (!std::isfinite(incidence)) return SurfaceCell::kUnknownIncidence;
  return static_cast<std::uint8_t>(
      std::clamp(incidence * kIncidenceSteps + 0.5, 0.0, static_cast<double>(kMostIncidence)));
}

/// A common sigma, C, by its code: squares, so that it is exact and fine where it is small.
double commonOf(std::uint64_t code) {
  return code == 0 ? 0.0 : static_cast<double>((code - 1) * (code - 1)) / kCommonSteps;
}
std::uint64_t commonCode(double sigma) {
  return 1 +
         static_cast<std::uint64_t>(std::min(std::sqrt(std::abs(sigma) * kCommonSteps) + 0.5, kMostCommon));
}

/// What an observation of these sigmas weighs, before it is guarded.
double weightOf(double sigma, double common) {
  constexpr double least = SurfaceCell::kMinSigma * SurfaceCell::kMinSigma;
  constexpr double most = SurfaceCell::kMaxSigma * SurfaceCell::kMaxSigma;
  return kWeightSteps / std::clamp(sigma * sigma + SurfaceCell::kCommonViews * common * common, least, most);
}

/// Cosines of the incidence codes, in 2^-40.
const std::array<double, 256> kCosines = [] {
  std::array<double, 256> cosines{};
  for (std::size_t code = 0; code < cosines.size(); ++code) {
    // Rounded, because the last bits of a cosine differ between processors.
    const double cosine = std::cos(static_cast<double>(code) / kIncidenceSteps);
    cosines[code] = std::max(std::round(std::ldexp(cosine, 40)), 0.0);
  }
  cosines[SurfaceCell::kUnknownIncidence] = std::ldexp(kUnknownCosine, 40);
  return cosines;
}();

/// Whether view a is better than view b: more pixels on the cell, cos(incidence) / range^2; ties by the
/// codes.
bool isBetterView(std::uint64_t range_a, std::uint64_t incidence_a, std::uint64_t range_b,
                  std::uint64_t incidence_b) {
  const auto near_a = static_cast<double>(std::max<std::uint64_t>(range_a, 1));
  const auto near_b = static_cast<double>(std::max<std::uint64_t>(range_b, 1));
  const double pixels_a = kCosines[incidence_a] * (near_b * near_b);
  const double pixels_b = kCosines[incidence_b] * (near_a * near_a);
  if (pixels_a != pixels_b) return pixels_a > pixels_b;
  return std::tie(range_a, incidence_a) < std::tie(range_b, incidence_b);
}

}  // namespace

/// Adds observations; of two too many for one cell the busier one's stand, ties by the sums.
inline void SurfaceCell::takeSums(const Sums& other) {
  const Sums own{observations, weight_sum, weighted_sum, weighted_square_sum, common_code};
  const bool both_known = own.common_code > 0 && other.common_code > 0;
  const std::uint64_t least = both_known ? std::min(own.common_code, other.common_code)
                                         : std::max(own.common_code, other.common_code);
  const bool fits = own.observations + other.observations <= kMaxObservations;
  const Sums sums = fits ? Sums{own.observations + other.observations, own.weight + other.weight,
                                own.weighted + other.weighted, own.square + other.square, least}
                         : std::max(own, other);
  observations = sums.observations;
  weight_sum = sums.weight;
  weighted_sum = sums.weighted;
  weighted_square_sum = sums.square;
  common_code = sums.common_code;
}

/// To be called before the observations are added.
inline void SurfaceCell::takeExtremes(const Extremes& other) {
  const bool first_here = observations == 0;
  if (first_here || other.min_code < min_code) min_code = other.min_code;
  if (first_here || other.max_code > max_code) max_code = other.max_code;
  if (first_here || other.first_code < first_code) first_code = other.first_code;
  if (first_here || other.last_code > last_code) last_code = other.last_code;
  if (first_here || isBetterView(other.range_cm, other.incidence, best_range_cm, best_incidence)) {
    best_range_cm = other.range_cm;
    best_incidence = other.incidence;
  }
}

void checkFinite(const TemperatureObservation& observation) {
  if (std::isfinite(observation.celsius) && std::isfinite(observation.sigma) &&
      std::isfinite(observation.common_sigma)) {
    return;
  }
  throw DataError("a temperature of " + std::to_string(observation.celsius) + " C with sigma " +
                  std::to_string(observation.sigma) + " C and common sigma " +
                  std::to_string(observation.common_sigma) + " C came to the map, expected finite numbers");
}

double SurfaceCell::guardedShare(double celsius, double variance) const {
  if (observations < kGuardAfter) return 1.0;
  const double off = std::abs(celsius - mean());
  // Most are within the narrowest guard there is: the spread need not be known.
  const double narrowest = kGuardSigmas * kGuardSigmas * (variance + kGuardFloor * kGuardFloor);
  if (off * off <= narrowest) return 1.0;
  const double widest = std::max(spread(), kGuardFloor);
  const double common = commonSigma();
  return std::min(1.0, kGuardSigmas * std::sqrt(variance + common * common + widest * widest) / off);
}

void SurfaceCell::addTemperature(const TemperatureObservation& observation, Time stamp) {
  checkFinite(observation);
  const double celsius = std::clamp<double>(observation.celsius, kMinCelsius, kMaxCelsius);
  const double sigma = std::clamp<double>(observation.sigma, kMinSigma, kMaxSigma);
  const std::uint64_t common_steps =
      std::isnan(observation.incidence) ? 0 : commonCode(observation.common_sigma);
  const double common = commonOf(common_steps);
  const double weight = weightOf(sigma, common) * guardedShare(celsius, sigma * sigma + common * common);
  const auto w = static_cast<std::uint64_t>(std::max(weight + 0.5, 1.0));
  const auto t = static_cast<std::uint64_t>((celsius - kZeroCelsius) * kTemperatureSteps + 0.5);
  constexpr std::uint64_t half = std::uint64_t{1} << (kSquareShift - 1);
  const std::uint64_t from_zero = stampFromZero(stamp);
  const std::uint64_t extreme = extremeCode(celsius);
  takeExtremes({.min_code = extreme,
                .max_code = extreme,
                .first_code = from_zero >> kFirstShift,
                .last_code = from_zero >> kLastShift,
                .range_cm = rangeCode(observation.range),
                .incidence = incidenceCode(observation.incidence)});
  takeSums({1, w, w * t, (w * (t * t) + half) >> kSquareShift, common_steps});
}

void SurfaceCell::merge(const SurfaceCell& other) {
  if (returns + other.returns <= kMaxReturns) {
    returns += other.returns;
    for (std::size_t i = 0; i < 3; ++i) offset_sum[i] += other.offset_sum[i];
  } else if (const auto order =
                 [](const SurfaceCell& c) {
                   return std::make_tuple(+c.returns, +c.offset_sum[0], +c.offset_sum[1], +c.offset_sum[2]);
                 };
             order(*this) < order(other)) {
    std::tie(returns, offset_sum) = std::tie(other.returns, other.offset_sum);  // the busier one's position
  }
  if (other.observations == 0) return;
  takeExtremes({other.min_code, other.max_code, other.first_code, other.last_code, other.best_range_cm,
                other.best_incidence});
  takeSums({other.observations, other.weight_sum, other.weighted_sum, other.weighted_square_sum,
            other.common_code});
}

bool SurfaceCell::isPlausible() const {
  if (returns + observations == 0) return false;
  for (const std::uint64_t sum : offset_sum) {
    if (sum > 255 * returns) return false;
  }
  if (observations > 0) return hasPlausibleTemperature();
  SurfaceCell without;
  without.returns = returns;
  without.offset_sum = offset_sum;
  return *this == without;
}

bool SurfaceCell::hasPlausibleTemperature() const {
  // Of several observations those of unknown angle weigh as if they had nothing in common.
  const double common = observations == 1 ? commonSigma() : 0.0;
  const auto most_weight = static_cast<std::uint64_t>(weightOf(kMinSigma, common) + 0.5);
  constexpr auto most_first = (std::uint64_t{1} << 32) - 1;
  if (observations > kMaxObservations) return false;
  if (weight_sum < observations || weight_sum > observations * most_weight) return false;
  if (best_incidence > kMostIncidence && best_incidence != kUnknownIncidence) return false;
  if (min_code > max_code || max_code > extremeCode(kMaxCelsius) || min_code < extremeCode(kMinCelsius))
    return false;
  if (first_code > std::min(last_code >> (kFirstShift - kLastShift), most_first)) return false;
  if (observations == 1 && (min_code != max_code || first_code != last_code >> (kFirstShift - kLastShift)))
    return false;
  constexpr double tolerance = 0.5 / kExtremeSteps + 0.5 / kTemperatureSteps + 1e-6;  // both are rounded
  if (!(mean() >= minCelsius() - tolerance && mean() <= maxCelsius() + tolerance)) return false;
  // Each square was rounded to the nearest whole unit.
  const double lost =
      0.5 * static_cast<double>(observations) / static_cast<double>(weight_sum) / kSquareSteps + 1e-6;
  const double most = maxCelsius() - kZeroCelsius + tolerance;
  return meanSquare() >= meanFromZero() * meanFromZero() - lost && meanSquare() <= most * most + lost;
}

Eigen::Vector3d SurfaceCell::meanOffset() const {
  if (returns == 0) return Eigen::Vector3d::Constant(0.5);
  const Eigen::Vector3d sum(static_cast<double>(offset_sum[0]), static_cast<double>(offset_sum[1]),
                            static_cast<double>(offset_sum[2]));
  return (sum.array() / static_cast<double>(returns) + 0.5) / kOffsetSteps;
}

double SurfaceCell::meanFromZero() const {
  return static_cast<double>(weighted_sum) / static_cast<double>(weight_sum) / kTemperatureSteps;
}

double SurfaceCell::mean() const {
  return meanFromZero() + kZeroCelsius;
}

double SurfaceCell::sigmaOfMean() const {
  const auto number = static_cast<double>(observations);
  const double common = commonSigma() * commonSigma();
  const double own =
      std::max(number * kWeightSteps / static_cast<double>(weight_sum) - kCommonViews * common, 0.0);
  const double scatter = spread() * spread();
  const double unexplained = std::max(scatter - kExplainedSpread * kExplainedSpread * own, 0.0);
  const double apart = maxCelsius() - minCelsius();
  const double off = 0.5 * (apart - std::sqrt(std::max(apart * apart - 4.0 * unexplained, 0.0)));
  return std::sqrt(std::max(own, scatter) / number + common + off * off);
}

double SurfaceCell::commonSigma() const {
  return commonOf(common_code);
}

double SurfaceCell::meanSquare() const {
  return static_cast<double>(weighted_square_sum) / static_cast<double>(weight_sum) / kSquareSteps;
}

double SurfaceCell::spread() const {
  return std::sqrt(std::max(meanSquare() - meanFromZero() * meanFromZero(), 0.0));
}

double SurfaceCell::minCelsius() const {
  return extremeOf(min_code);
}

double SurfaceCell::maxCelsius() const {
  return extremeOf(max_code);
}

Time SurfaceCell::first() const {
  return stampOf(first_code, kFirstShift);
}

Time SurfaceCell::last() const {
  return stampOf(last_code, kLastShift);
}

SurfaceCell::View SurfaceCell::bestView() const {
  const auto range = static_cast<float>(static_cast<double>(best_range_cm) / kRangeSteps);
  if (best_incidence == kUnknownIncidence) return {range, std::numeric_limits<float>::quiet_NaN()};
  return {range, static_cast<float>(static_cast<double>(best_incidence) / kIncidenceSteps)};
}

}  // namespace thermovox
