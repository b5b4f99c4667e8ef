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
constexpr std::uint32_t kGuardAfter = 4;  // observations that pass unguarded
constexpr double kGuardSigmas = 2.5;      // loses 1.6 % of efficiency on clean Gaussian data
constexpr double kGuardFloor = 0.1;       // C; two frames of a camera agree no better
constexpr double kRangeSteps = 100.0;     // a metre
constexpr double kIncidenceSteps = 1e4;   // a radian
constexpr double kUnknownCosine = 0.5;    // an unknown incidence counts as 60 degrees

std::uint16_t rangeCode(float range) {
  return static_cast<std::uint16_t>(range >= 0.0F ? std::min(std::round(range * kRangeSteps), 65535.0)
                                                  : 65535.0);
}

std::uint16_t incidenceCode(float incidence) {
  if (!std::isfinite(incidence)) return SurfaceCell::kUnknownIncidence;
  return static_cast<std::uint16_t>(std::clamp(std::round(incidence * kIncidenceSteps), 0.0, 65534.0));
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
  observations += other.observations;
  weight_sum += other.weight_sum;
  weighted_sum += other.weighted_sum.value();
  weighted_square_sum += other.weighted_square_sum.value();
}

bool SurfaceCell::isPlausible() const {
  for (const std::uint32_t sum : offset_sum) {
    if (sum > 255ULL * returns) return false;
  }
  if (returns > kMaxReturns) return false;
  if (observations == 0) return weight_sum == 0 && weighted_sum == Sum96{} && weighted_square_sum == Sum96{};
  // Written so that NaN is refused too.
  const bool in_range =
      min_celsius >= kMinCelsius - 0.01 && max_celsius <= kMaxCelsius && min_celsius <= max_celsius;
  if (!in_range || first_ns > last_ns || weight_sum < observations) return false;
  return mean() >= min_celsius - 0.01 && mean() <= max_celsius + 0.01;
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
  return std::sqrt(kWeightSteps / static_cast<double>(weight_sum));
}

double SurfaceCell::spread() const {
  const double mean_from_zero = mean() - kZeroCelsius;
  const double mean_square =
      static_cast<double>(weighted_square_sum.value()) / static_cast<double>(weight_sum) / kSquareSteps;
  return std::sqrt(std::max(mean_square - mean_from_zero * mean_from_zero, 0.0));
}

SurfaceCell::View SurfaceCell::bestView() const {
  const bool known = best_incidence != kUnknownIncidence;
  return {
      static_cast<float>(best_range_cm / kRangeSteps),
      known ? static_cast<float>(best_incidence / kIncidenceSteps) : std::numeric_limits<float>::quiet_NaN()};
}

}  // namespace thermovox
