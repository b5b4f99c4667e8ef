#include "apps/simulate/laser_sampling.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "apps/simulate/random.hpp"
#include "apps/simulate/simulated_rig.hpp"

namespace thermovox::simulate {
namespace {

/// One echo: what the laser says of it.
struct Echo {
  double range = 0.0;  ///< metres
  double intensity = 0.0;
};

/// Casts rays of one body pose.
class Caster {
 public:
  Caster(const Simulation& simulation, Time stamp)
      : simulation_(simulation), T_world_laser_(simulation.truePose(stamp) * simulation.trueBodyLaser()) {}

  /// nullopt where nothing is in reach. Always draws one normal number, so that echoes do not shift the noise
  /// of those after them.
  [[nodiscard]] std::optional<Echo> cast(const Eigen::Vector3d& d_laser, Random& random) const {
    const double noise =
        simulation_.options().range_sigma * random.normal() + simulation_.drawnErrors().range_bias;
    const Eigen::Vector3d d_world = T_world_laser_.rotation * d_laser;
    const std::optional<Hit> hit = simulation_.hall().castRay(T_world_laser_.translation, d_world);
    if (!hit) return std::nullopt;
    const double range = hit->range + noise;
    const Laser& laser = simulation_.rig().lasers.front();
    if (!(range >= laser.range_min && range <= laser.range_max)) return std::nullopt;
    // A matt surface: falls with the cosine of the incidence, and slowly with the range.
    const double cosine = std::abs(hit->normal.dot(d_world));
    return Echo{range, 250.0 + 1500.0 * cosine / (1.0 + 0.1 * range)};
  }

 private:
  const Simulation& simulation_;
  Pose T_world_laser_;
};

void weaken(Echo& echo, double min_intensity, Random& random) {
  echo.range *= random.uniform(0.35, 0.95);
  echo.intensity = min_intensity * random.uniform(0.05, 0.9);
}

}  // namespace

BeamReading sampleBeam(const Simulation& simulation, std::size_t sweep) {
  Random random(simulation.options().seed, RandomStream::laser, sweep);
  const Time stamp = simulation.sweepStamp(sweep);
  const auto echo = Caster(simulation, stamp).cast(Eigen::Vector3d::UnitX(), random);
  if (!echo) return {stamp, std::numeric_limits<double>::infinity(), 0.0F};
  return {stamp, echo->range, static_cast<float>(std::round(echo->intensity))};
}

std::vector<float> sampleScan(const Simulation& simulation, std::size_t sweep) {
  Random random(simulation.options().seed, RandomStream::laser, sweep);
  const Laser& laser = simulation.rig().lasers.front();
  const Time start = simulation.sweepStamp(sweep);
  std::vector<float> ranges;
  ranges.reserve(kScanReadings);
  for (int i = 0; i < kScanReadings; ++i) {
    const double angle = laser.angle_min + i * laser.angle_increment;
    const Caster caster(simulation, start + i * laser.time_increment);
    const auto echo = caster.cast({std::cos(angle), std::sin(angle), 0.0}, random);
    ranges.push_back(echo ? static_cast<float>(echo->range) : std::numeric_limits<float>::infinity());
  }
  return ranges;
}

std::vector<CloudPoint> sampleCloud(const Simulation& simulation, std::size_t sweep) {
  const SimulationOptions& options = simulation.options();
  Random random(options.seed, RandomStream::laser, sweep);
  const Time start = simulation.sweepStamp(sweep);
  std::vector<CloudPoint> points;
  points.reserve(static_cast<std::size_t>(kCloudBeams * kCloudColumns));
  for (int column = 0; column < kCloudColumns; ++column) {
    // The time as the file holds it, so that the cast is of the very moment that a reader sees.
    const float time = static_cast<float>(column / (options.cloud_rate * kCloudColumns));
    const double azimuth = 2.0 * std::numbers::pi * column / kCloudColumns - std::numbers::pi;
    const Caster caster(simulation, start + durationFromSeconds(time));
    for (int beam = 0; beam < kCloudBeams; ++beam) {
      const double elevation = cloudElevation(beam);
      const Eigen::Vector3d d_laser(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      std::optional<Echo> echo = caster.cast(d_laser, random);
      const bool weak = random.uniform() < options.outlier_share;
      if (!echo) continue;
      if (weak) weaken(*echo, simulation.rig().lasers.front().min_intensity, random);
      points.push_back({(echo->range * d_laser).cast<float>(), static_cast<float>(echo->intensity), time});
    }
  }
  return points;
}

}  // namespace thermovox::simulate
