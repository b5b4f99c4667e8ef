#include "apps/simulate/simulated_sources.hpp"

#include <cassert>
#include <limits>
#include <memory>
#include <utility>

#include "apps/simulate/laser_sampling.hpp"
#include "projection/laser/multi_beam.hpp"
#include "projection/laser/planar_scanner.hpp"
#include "projection/laser/range_finder.hpp"

namespace thermovox::simulate {

Mission missionOf(const Simulation& simulation, const std::string& name) {
  const DeclaredErrors& errors = simulation.options().errors;
  return {.name = name,
          .rig = simulation.rig(),
          .trajectory = Trajectory(simulation.writtenPoses()),
          .pose_rotation_sigma = errors.pose_rotation_sigma,
          .pose_translation_sigma = errors.pose_translation_sigma,
          .ambient = std::nullopt};
}

Reading readSweep(const Simulation& simulation, std::size_t sweep) {
  const Laser& laser = simulation.rig().lasers.front();
  switch (simulation.options().laser) {
    case LaserKind::beam:
      return readingFromBeam(sampleBeam(simulation, sweep), laser);
    case LaserKind::scan:
      return readingFromScan(simulation.sweepStamp(sweep), sampleScan(simulation, sweep), laser);
    case LaserKind::cloud:
      break;
  }
  return readingFromCloud(simulation.sweepStamp(sweep), sampleCloud(simulation, sweep), laser);
}

std::optional<Reading> SimulatedReadings::next() {
  if (next_ >= simulation_.sweepCount()) return std::nullopt;
  return readSweep(simulation_, next_++);
}

std::optional<ThermalFrame> SimulatedFrames::next() {
  assert(simulation_.options().frames == FrameFormat::tiff);
  if (next_ >= simulation_.frameCount()) return std::nullopt;
  const ThermalCamera& thermal = *simulation_.rig().thermal_camera;
  auto image = std::make_shared<ThermalImage>();
  image->width = thermal.camera.width();
  image->height = thermal.camera.height();
  for (const std::uint16_t count : renderer_.counts(next_)) {
    image->celsius.push_back(count == 0 ? std::numeric_limits<float>::quiet_NaN()
                                        : static_cast<float>(thermal.t_linear->celsius(count)));
  }
  const std::size_t frame = next_++;
  return ThermalFrame{simulation_.frameStamp(frame), std::move(image), "frame " + std::to_string(frame)};
}

Duration SimulatedFrames::period() const {
  if (simulation_.frameCount() < 2) return Duration::zero();
  return durationFromSeconds(1.0 / simulation_.options().frame_rate);
}

}  // namespace thermovox::simulate
