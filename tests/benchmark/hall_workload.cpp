#include "tests/benchmark/hall_workload.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace thermovox::bench {
namespace {

constexpr double kAisle = 7.0, kLeg = 43.0;  // metres: up one aisle, across to the next but one, down it

/// Where the laser is after `way` metres of its 100, pitching and rolling a little.
Pose poseAfter(double way) {
  const double height = 4.0 + 2.0 * std::sin(way * 2.0 * std::numbers::pi / 37.0);
  Eigen::Vector3d position(-kLeg / 2 + way, -kAisle, height);
  double heading = 0.0;
  if (way > kLeg) {
    position.head<2>() = Eigen::Vector2d(kLeg / 2, -kAisle + (way - kLeg));
    heading = std::numbers::pi / 2;
  }
  if (way > kLeg + 2 * kAisle) {
    position.head<2>() = Eigen::Vector2d(kLeg / 2 - (way - kLeg - 2 * kAisle), kAisle);
    heading = std::numbers::pi;
  }
  const Eigen::AngleAxisd yaw(heading, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd pitch(0.04 * std::sin(way / 3.0), Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd roll(0.04 * std::cos(way / 5.0), Eigen::Vector3d::UnitX());
  return {Eigen::Quaterniond(yaw * pitch * roll), position};
}

}  // namespace

HallWorkload::HallWorkload(std::uint64_t seed) {
  const HallScene scene(seed);
  for (int i = 0; i < kScans; ++i) scans_.push_back(fly(scene, i, seed));
}

HallWorkload::Scan HallWorkload::fly(const HallScene& scene, int index, std::uint64_t seed) {
  std::mt19937_64 random(seed * kScans + static_cast<std::uint64_t>(index));
  std::normal_distribution<double> noise;
  Scan scan{poseAfter(100.0 * index / kScans), {}};
  scan.returns.reserve(std::size_t{kRings} * kColumns);
  for (int column = 0; column < kColumns; ++column) {
    for (int ring = 0; ring < kRings; ++ring) {
      const double azimuth = (column + 0.37) * 2.0 * std::numbers::pi / kColumns;
      const double elevation = (ring - (kRings - 1) / 2.0) / kRings * std::numbers::pi / 2;
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d direction = scan.T_world_laser.rotation * beam;
      const HallScene::Hit hit = scene.cast(scan.T_world_laser.translation, direction);
      const double range = hit.range + kRangeNoise * noise(random);
      const double celsius = hit.celsius + 0.1 * noise(random);
      if (range > kMaxRange) continue;
      const Eigen::Vector3d p_world = scan.T_world_laser.translation + range * direction;
      const double cosine = std::min(1.0, -hit.normal.dot(direction));
      scan.returns.push_back(
          {p_world.cast<float>(), static_cast<float>(celsius), static_cast<float>(std::acos(cosine))});
    }
  }
  return scan;
}

std::vector<MappedReturn> HallWorkload::scan(int index) const {
  const Scan& scan = scans_[static_cast<std::size_t>(index)];
  const Eigen::Vector3d& origin = scan.T_world_laser.translation;
  std::vector<MappedReturn> returns;
  returns.reserve(scan.returns.size());
  for (const Return& ret : scan.returns) {
    const Eigen::Vector3d p_world = ret.p_world.cast<double>();
    const auto range = static_cast<float>((p_world - origin).norm());
    returns.push_back({p_world, origin, Time(std::chrono::seconds(index)),
                       TemperatureObservation{ret.celsius, 0.15F, range, ret.incidence}});
  }
  return returns;
}

const HallWorkload& hallWorkload() {
  static const HallWorkload workload;
  return workload;
}

}  // namespace thermovox::bench
