#include "projection/laser/range_gate.hpp"

#include <cmath>

namespace thermovox {
namespace {

/// The limits belong to the valid ranges. A reading that went through a float, or a sine and a cosine, may
/// come out this much beside itself (a relative error).
constexpr double kRounding = 1e-6;

}  // namespace

void appendIfValid(Reading& reading, const LaserReturn& candidate, const Laser& laser) {
  const double range = candidate.range();
  if (!std::isfinite(range) || range == 0.0) {
    ++reading.dropped.no_return;
  } else if (range < laser.range_min * (1.0 - kRounding)) {
    ++reading.dropped.too_near;
  } else if (range > laser.range_max * (1.0 + kRounding)) {
    ++reading.dropped.too_far;
  } else if (candidate.intensity < laser.min_intensity) {
    ++reading.dropped.too_weak;
  } else {
    reading.returns.push_back(candidate);
  }
}

double echoOrNan(double range) {
  return range > 0.0 ? range : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace thermovox
