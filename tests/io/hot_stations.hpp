#pragma once

#include <string>
#include <vector>

#include "io/rig_file.hpp"
#include "tests/io/stations.hpp"
#include "tests/support/hot_surface.hpp"

namespace thermovox::test {

/// A rig with a thermal camera and a laser, all in the body's origin.
inline constexpr const char* kHotRig = R"(thermal_camera:
  width: 160
  height: 120
  model: pinhole
  fx: 150
  fy: 150
  cx: 79.5
  cy: 59.5
  bias_sigma: 2.0
  T_body_camera: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}
laser:
  kind: cloud
  T_body_laser: {translation: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}
  range_min: 0.1
  range_max: 100.0
  range_sigma: 0.01
)";

/// A mission over a plate with peaks; it flies `day` days after the first.
[[nodiscard]] inline MissionRecord hotRecord(const std::string& name, int day) {
  MissionRecord mission = record(name);
  mission.rig = kHotRig;
  mission.first = Time(std::chrono::hours(24 * day) + std::chrono::seconds(1000));
  mission.last = *mission.first + std::chrono::minutes(10);
  return mission;
}

[[nodiscard]] inline ThermalMap hotMission(const std::vector<HotPeak>& peaks, int day,
                                           double celsius = 20.0) {
  const SurfaceNoise noise{.seed = static_cast<unsigned>(day) + 1,
                           .start = Time(std::chrono::hours(24 * day) + std::chrono::seconds(1000))};
  return plateWith(peaks, noise, {}, celsius);
}

}  // namespace thermovox::test
