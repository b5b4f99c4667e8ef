#include "apps/simulate/capture_laser.hpp"

#include <cmath>

#include "apps/simulate/capture_rig.hpp"
#include "apps/simulate/mounting.hpp"
#include "apps/simulate/random.hpp"
#include "projection/laser/planar_scanner.hpp"

namespace thermovox::simulate {
namespace {

constexpr int kBeamReadings = 100;
constexpr int kSweeps = 20;
constexpr int kCloudUp = 60;      // rows above and below the middle one
constexpr int kCloudAside = 133;  // columns beside it
constexpr float kIntensity = 150.0F;

/// One capture every ten seconds.
Time stampOf(std::size_t capture, double seconds) {
  return Time{} + std::chrono::seconds(1'700'000'000 + 10 * static_cast<std::int64_t>(capture)) +
         durationFromSeconds(seconds);
}

/// Casts the rays of one capture.
class CaptureCaster {
 public:
  CaptureCaster(const CaptureScene& scene, std::size_t capture)
      : scene_(scene),
        capture_(scene.captures().at(capture)),
        random_(scene.options().seed, RandomStream::laser, capture) {}

  [[nodiscard]] double range(const Eigen::Vector3d& d_laser, const Eigen::Vector2d& off_spot = {0.0, 0.0}) {
    const std::optional<double> plate = scene_.rangeOfPlate(capture_, d_laser, off_spot);
    const double noise = scene_.options().range_sigma * random_.normal();
    return (plate ? *plate : scene_.rangeOfRoom(d_laser)) + capture_.range_bias + noise;
  }
  [[nodiscard]] Eigen::Vector2d offSpot() {
    const double x = random_.normal();
    const double y = random_.normal();
    return scene_.options().beam_spot_sigma * Eigen::Vector2d(x, y);
  }

 private:
  const CaptureScene& scene_;
  const BoardCapture& capture_;
  Random random_;
};

}  // namespace

std::vector<BeamReading> measureBeam(const CaptureScene& scene, std::size_t capture) {
  CaptureCaster caster(scene, capture);
  std::vector<BeamReading> readings;
  for (int i = 0; i < kBeamReadings; ++i) {
    const Eigen::Vector2d off_spot = caster.offSpot();
    readings.push_back({stampOf(capture, 0.01 * i), caster.range(Eigen::Vector3d::UnitX(), off_spot)});
  }
  return readings;
}

std::vector<CaptureSweep> measureScans(const CaptureScene& scene, std::size_t capture) {
  CaptureCaster caster(scene, capture);
  const Laser& laser = scene.trueRig().lasers.front();
  std::vector<CaptureSweep> sweeps;
  for (int i = 0; i < kSweeps; ++i) {
    CaptureSweep sweep{stampOf(capture, 0.05 * i), {}};
    for (int step = 0; step < kCaptureScanReadings; ++step) {
      const double angle = laser.angle_min + step * laser.angle_increment;
      sweep.ranges.push_back(static_cast<float>(caster.range({std::cos(angle), std::sin(angle), 0.0})));
    }
    sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

std::vector<CloudPoint> measureCloud(const CaptureScene& scene, std::size_t capture) {
  CaptureCaster caster(scene, capture);
  std::vector<CloudPoint> points;
  for (int row = -kCloudUp; row <= kCloudUp; ++row) {
    const double elevation = 0.5 * kDegree * row;
    for (int column = -kCloudAside; column <= kCloudAside; ++column) {
      const double azimuth = 0.45 * kDegree * column;
      const Eigen::Vector3d d_laser(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      points.push_back({(caster.range(d_laser) * d_laser).cast<float>(), kIntensity});
    }
  }
  return points;
}

std::vector<Reading> measureCapture(const CaptureScene& scene, std::size_t capture) {
  const Laser& laser = scene.trueRig().lasers.front();
  std::vector<Reading> readings;
  switch (laser.kind) {
    case LaserKind::beam:
      for (const BeamReading& beam : measureBeam(scene, capture))
        readings.push_back(readingFromBeam(beam, laser));
      break;
    case LaserKind::scan:
      for (const CaptureSweep& sweep : measureScans(scene, capture))
        readings.push_back(readingFromScan(sweep.stamp, sweep.ranges, laser));
      break;
    case LaserKind::cloud:
      readings.push_back(readingFromCloud(stampOf(capture, 0.0), measureCloud(scene, capture), laser));
      break;
  }
  return readings;
}

}  // namespace thermovox::simulate
