#pragma once

#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mapping/mission_mapper.hpp"
#include "tests/projection/scene.hpp"

namespace thermovox::test {

inline constexpr double kPeriod = 0.2;  // seconds from frame to frame
/// What mapMission takes for that period.
inline const Duration kFrameLimit = durationFromSeconds(kPeriod / 2 + 0.05);
inline constexpr double kWall = 5.0;  // metres; a wall across x, and the camera looks along x

[[nodiscard]] inline Time at(double seconds) {
  return Time(durationFromSeconds(seconds));
}

[[nodiscard]] inline Camera wideCamera() {
  Intrinsics intrinsics{.width_px = 64, .height_px = 48};
  intrinsics.parameters = {40.0, 40.0, 31.5, 23.5};
  return Camera(intrinsics);
}

/// The optical frame looks along the body's x.
[[nodiscard]] inline Pose lookingAhead() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(R_body_camera), {0.1, 0.0, 0.05}};
}

/// A body that moves along y by `speed` (m/s) and turns about z by `turn` (rad/s), with poses at 100 Hz from
/// 10 s to 20 s.
[[nodiscard]] inline std::vector<StampedPose> poses(double speed, double turn) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.01 * i;
    const Eigen::AngleAxisd rotation(turn * t, Eigen::Vector3d::UnitZ());
    poses.push_back({at(10.0 + t), {Eigen::Quaterniond(rotation), {0.0, speed * t, 1.0}}});
  }
  return poses;
}

[[nodiscard]] inline Mission missionOf(std::vector<StampedPose> poses) {
  Mission mission{.name = "synthetic"};
  mission.rig.lasers.push_back(Laser{.kind = LaserKind::beam, .range_sigma = 0.01});
  mission.rig.thermal_camera = ThermalCamera{.camera = wideCamera(), .T_body_camera = lookingAhead()};
  mission.trajectory = Trajectory(std::move(poses));
  return mission;
}

/// Echoes of the wall near the laser's axis: `count` points from `stamp` on, a millisecond apart.
[[nodiscard]] inline Reading readingAt(double stamp, int count = 1) {
  Reading reading{.stamp = at(stamp)};
  for (int i = 0; i < count; ++i) {
    reading.returns.push_back({at(stamp) + std::chrono::milliseconds(i), {kWall, 0.02 * i, 0.01 * i}});
  }
  return reading;
}

[[nodiscard]] inline ThermalFrame frameAt(double stamp, double celsius) {
  const Camera camera = wideCamera();
  return frameOf(imageOf(camera.width(), camera.height(), [&](int, int) { return celsius; }), at(stamp));
}

class Readings final : public ReadingSource {
 public:
  explicit Readings(std::vector<Reading> readings) : readings_(std::move(readings)) {}
  std::optional<Reading> next() override {
    if (next_ == readings_.size()) return std::nullopt;
    return readings_[next_++];
  }

 private:
  std::vector<Reading> readings_;
  std::size_t next_ = 0;
};

class Frames final : public FrameSource {
 public:
  explicit Frames(std::vector<ThermalFrame> frames) : frames_(std::move(frames)) {}
  std::optional<ThermalFrame> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }
  Duration period() const override { return durationFromSeconds(kPeriod); }

 private:
  std::vector<ThermalFrame> frames_;
  std::size_t next_ = 0;
};

/// What came out of mapping a mission.
struct Result {
  ThermalMap map{ThermalMap::Options{}};
  std::vector<ColouredReturn> points;
  MissionReport report;
};

[[nodiscard]] inline Result mapAll(const Mission& mission, std::vector<Reading> readings,
                                   std::vector<ThermalFrame> frames,
                                   const MissionMapper::Options& options = {}) {
  Result result;
  Readings reading_source(std::move(readings));
  Frames frame_source(std::move(frames));
  FrameSource* frame_stream = mission.rig.thermal_camera ? &frame_source : nullptr;
  result.report = mapMission({mission, reading_source, frame_stream}, result.map, options,
                             {.points = [&result](std::span<const ColouredReturn> reading) {
                               result.points.insert(result.points.end(), reading.begin(), reading.end());
                             }});
  return result;
}

/// Every point has a temperature or is counted with the reason why not.
inline void expectAccountOfEveryPoint(const MissionReport& report) {
  const std::size_t uncoloured =
      std::accumulate(report.uncoloured.begin(), report.uncoloured.end(), std::size_t{0},
                      [](std::size_t sum, const auto& reason) { return sum + reason.second; });
  EXPECT_EQ(report.points, report.coloured + uncoloured);
}

}  // namespace thermovox::test
