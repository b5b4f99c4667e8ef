#include "projection/laser/planar_scanner.hpp"

#include <cmath>

#include "projection/laser/range_gate.hpp"

namespace thermovox {

Reading readingFromScan(Time stamp, std::span<const float> ranges, const Laser& laser) {
  Reading reading{.stamp = stamp};
  reading.returns.reserve(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double angle = laser.angle_min + static_cast<double>(i) * laser.angle_increment;
    const double range = echoOrNan(ranges[i]);
    const Eigen::Vector3d p_laser(range * std::cos(angle), range * std::sin(angle), 0.0);
    const Time taken = stamp + static_cast<Duration::rep>(i) * laser.time_increment;
    appendIfValid(reading, {.stamp = taken, .p_laser = p_laser}, laser);
  }
  return reading;
}

}  // namespace thermovox
