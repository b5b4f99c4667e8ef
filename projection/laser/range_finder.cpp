#include "projection/laser/range_finder.hpp"

#include "projection/laser/range_gate.hpp"

namespace thermovox {

Reading readingFromBeam(const BeamReading& beam, const Laser& laser) {
  Reading reading{.stamp = beam.stamp};
  appendIfValid(reading, {beam.stamp, Eigen::Vector3d(echoOrNan(beam.range), 0.0, 0.0), beam.intensity},
                laser);
  return reading;
}

}  // namespace thermovox
