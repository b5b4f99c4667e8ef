#include "mapping/surface_cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kZeroCelsius = -274.0;  // where temperatures count from: whole, so that 0 C is exact
constexpr double kOffsetSteps = 256.0;
constexpr double kTemperatureSteps = 65536.0;  // a degree
constexpr double kWeightSteps = 262144.0;      // 1 / C^2
constexpr int kSquareShift = 24;
constexpr double kSquareSteps = kTemperatureSteps * kTemperatureSteps / (1 << kSquareShift);
constexpr std::uint32_t kGuardAfter = 4;    // observations that pass unguarded
constexpr double kGuardSigmas = 2.5;        // loses 1.6 % of efficiency on clean Gaussian data
constexpr double kGuardFloor = 0.1;         // C; two frames of a camera agree no better
constexpr double kExplainedSpread = 2.0;    // as a multiple of what the sigmas promise
constexpr double kTolerance = 1e-4;         // C; more than the fixed point and 32-bit extremes round by
constexpr double kRangeSteps = 100.0;       // a metre
constexpr double kIncidenceSteps = 1e4;     // a radian
constexpr double kMostIncidence = 15708.0;  // a right angle
constexpr double kUnknownCosine = 0.5;      // an unknown incidence counts as 60 degrees

std::uint16_t rangeCode(float range) {
  return static_cast<std::uint16_t>(range >= 0.0F ? std::min(std::round(range * kRangeSteps), 65535.0)
                                                  : 65535.0);
}

std::uint16_t incidenceCode(float incidence) {
  if (!std::isfinite(incidence)) return SurfaceCell::kUnknownIncidence;
  return static_cast<std::uint16_t>(std::clamp(std::round(incidence * kIncidenceSteps), 0.0, kMostIncidence));
}

/// Orders views, the better first: most pixels on the cell, cos(incidence) / range^2; ties by the codes.
auto viewOrder(std::uint16_t range_cm, std::uint16_t incidence) {
  const double cosine = incidence == SurfaceCell::kUnknownIncidence
                            ? kUnknownCosine
                            : std::max(std::cos(incidence / kIncidenceSteps), 0.0);
  const double range = std::max<double>(range_cm, 1.0);
  return std::make_tuple(-cosine / (range * range), range_cm, incidence);
}

}  // namespace

void SurfaceCell::addReturn(const Eigen::Vector3d& offset) {
  if (returns >= kMaxReturns) return;
  for (int i = 0; i < 3; ++i) {
    offset_sum[i] += static_cast<std::uint32_t>(std::clamp(std::floor(offset[i] * kOffsetSteps), 0.0, 255.0));
  }
  ++returns;
}

void SurfaceCell::addTemperature(const TemperatureObservation& observation, Time stamp) {
  if (!std::isfinite(observation.celsius) || !std::isfinite(observation.sigma)) {
    throw DataError("a temperature of " + std::to_string(observation.celsius) + " C with sigma " +
                    std::to_string(observation.sigma) + " C came to the map, expected finite numbers");
  }
  const double celsius = std::clamp<double>(observation.celsius, kMinCelsius, kMaxCelsius);
  const double sigma = std::clamp<double>(observation.sigma, kMinSigma, kMaxSigma);
  double weight = kWeightSteps / (sigma * sigma);
  if (observations >= kGuardAfter) {
    const double limit = kGuardSigmas * std::hypot(sigma, std::max(spread(), kGuardFloor));
    weight *= std::min(1.0, limit / std::abs(celsius - mean()));
  }
  const auto w = static_cast<std::uint64_t>(std::max(std::llround(weight), 1LL));
  const auto t = static_cast<std::uint64_t>(std::llround((celsius - kZeroCelsius) * kTemperatureSteps));
  SurfaceCell single;
  single.weight_sum = w;
  single.weighted_sum += static_cast<Uint128>(w) * t;
  single.weighted_square_sum += (static_cast<Uint128>(w) * (t * t)) >> kSquareShift;
  single.observations = 1;
  single.first_ns = single.last_ns = stamp.time_since_epoch().count();
  single.min_celsius = single.max_celsius = static_cast<float>(celsius);
  single.best_range_cm = rangeCode(observation.range);
  single.best_incidence = incidenceCode(observation.incidence);
  merge(single);
}

void SurfaceCell::merge(const SurfaceCell& other) {
  if (other.returns <= kMaxReturns - std::min(returns, kMaxReturns)) {
    returns += other.returns;
    for (std::size_t i = 0; i < 3; ++i) offset_sum[i] += other.offset_sum[i];
  } else if (std::tie(returns, offset_sum) < std::tie(other.returns, other.offset_sum)) {
    std::tie(returns, offset_sum) = std::tie(other.returns, other.offset_sum);  // the busier one's position
  }
  if (other.observations == 0) return;
  const bool first_here = observations == 0;
  min_celsius = first_here ? other.min_celsius : std::min(min_celsius, other.min_celsius);
  max_celsius = first_here ? other.max_celsius : std::max(max_celsius, other.max_celsius);
  first_ns = first_here ? other.first_ns : std::min(first_ns, other.first_ns);
  last_ns = first_here ? other.last_ns : std::max(last_ns, other.last_ns);
  if (first_here ||
      viewOrder(other.best_range_cm, other.best_incidence) < viewOrder(best_range_cm, best_incidence)) {
    best_range_cm = other.best_range_cm;
    best_incidence = other.best_incidence;
  }
  addSums(other);
}

void SurfaceCell::addSums(const SurfaceCell& other) {
  if (other.observations <= std::numeric_limits<std::uint32_t>::max() - observations) {
    observations += other.observations;
    weight_sum += other.weight_sum;
    weighted_sum += other.weighted_sum.value();
    weighted_square_sum += other.weighted_square_sum.value();
    return;
  }
  const auto order = [](const SurfaceCell& cell) {  // the busier last, ties by the sums
    return std::make_tuple(cell.observations, cell.weight_sum, cell.weighted_sum.value(),
                           cell.weighted_square_sum.value());
  };
  if (order(other) <= order(*this)) return;
  observations = other.observations;
  weight_sum = other.weight_sum;
  weighted_sum = other.weighted_sum;
  weighted_square_sum = other.weighted_square_sum;
}

bool SurfaceCell::isPlausible() const {
  if (returns == 0 || returns > kMaxReturns) return false;
  for (const std::uint32_t sum : offset_sum) {
    if (sum > 255ULL * returns) return false;
  }
  if (observations > 0) return hasPlausibleTemperature();
  SurfaceCell without;
  without.returns = returns;
  without.offset_sum = offset_sum;
  return *this == without;
}

bool SurfaceCell::hasPlausibleTemperature() const {
  constexpr auto most_weight = static_cast<std::uint64_t>(kWeightSteps / (kMinSigma * kMinSigma) + 0.5);
  if (weight_sum < observations || weight_sum > observations * most_weight) return false;
  if (best_incidence > kMostIncidence && best_incidence != kUnknownIncidence) return false;
  // Written so that NaN is refused too.
  const bool in_range = min_celsius >= static_cast<float>(kMinCelsius) && max_celsius <= kMaxCelsius;
  if (!in_range || !(min_celsius <= max_celsius) || first_ns > last_ns) return false;
  if (observations == 1 && (min_celsius != max_celsius || first_ns != last_ns)) return false;
  if (!(mean() >= min_celsius - kTolerance && mean() <= max_celsius + kTolerance)) return false;
  // Each square may have lost almost one unit, and doubles lose the last bits of numbers up to 10^7.
  const double lost = static_cast<double>(observations) / static_cast<double>(weight_sum) / kSquareSteps;
  const double mean_from_zero = mean() - kZeroCelsius;
  const double max_from_zero = max_celsius - kZeroCelsius + kTolerance;
  return meanSquare() >= mean_from_zero * mean_from_zero - lost - kTolerance &&
         meanSquare() <= max_from_zero * max_from_zero;
}

Eigen::Vector3d SurfaceCell::meanOffset() const {
  const Eigen::Vector3d sum(offset_sum[0], offset_sum[1], offset_sum[2]);
  return (sum.array() / returns + 0.5) / kOffsetSteps;
}

double SurfaceCell::mean() const {
  return static_cast<double>(weighted_sum.value()) / static_cast<double>(weight_sum) / kTemperatureSteps +
         kZeroCelsius;
}

double SurfaceCell::sigmaOfMean() const {
  const double own = kWeightSteps / static_cast<double>(weight_sum);
  const double scatter = spread() * spread();
  const double number = observations;
  const double unexplained = std::max(scatter - kExplainedSpread * kExplainedSpread * number * own, 0.0);
  const double apart = static_cast<double>(max_celsius) - min_celsius;
  const double off = 0.5 * (apart - std::sqrt(std::max(apart * apart - 4.0 * unexplained, 0.0)));
  return std::sqrt(std::max(own, scatter / number) + off * off);
}

double SurfaceCell::meanSquare() const {
  return static_cast<double>(weighted_square_sum.value()) / static_cast<double>(weight_sum) / kSquareSteps;
}

double SurfaceCell::spread() const {
  const double mean_from_zero = mean() - kZeroCelsius;
  return std::sqrt(std::max(meanSquare() - mean_from_zero * mean_from_zero, 0.0));
}

SurfaceCell::View SurfaceCell::bestView() const {
  const bool known = best_incidence != kUnknownIncidence;
  return {
      static_cast<float>(best_range_cm / kRangeSteps),
      known ? static_cast<float>(best_incidence / kIncidenceSteps) : std::numeric_limits<float>::quiet_NaN()};
}

}  // namespace thermovox
