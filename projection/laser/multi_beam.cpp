#include "projection/laser/multi_beam.hpp"

#include <cmath>

#include "projection/laser/range_gate.hpp"

namespace thermovox {
namespace {

/// Seconds from a sweep's stamp to its points: a larger offset is a damaged field, not a time.
constexpr double kLongestSweep = 10.0;

}  // namespace

Reading readingFromCloud(Time stamp, std::span<const CloudPoint> points, const Laser& laser) {
  Reading reading{.stamp = stamp};
  reading.returns.reserve(points.size());
  for (const CloudPoint& point : points) {
    if (!(std::abs(point.time) <= kLongestSweep)) {
      ++reading.dropped.bad_time;
      continue;
    }
    const Time taken = stamp + durationFromSeconds(point.time);
    appendIfValid(reading, {taken, point.p_laser.cast<double>(), point.intensity}, laser);
  }
  return reading;
}

}  // namespace thermovox
