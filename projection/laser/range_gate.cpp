#include "projection/laser/range_gate.hpp"

#include <cmath>

namespace thermovox {

void appendIfValid(Reading& reading, const LaserReturn& candidate, const Laser& laser) {
  const double range = candidate.range();
  if (!std::isfinite(range) || range == 0.0) {
    ++reading.dropped.no_return;
  } else if (range < laser.range_min) {
    ++reading.dropped.too_near;
  } else if (range > laser.range_max) {
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
