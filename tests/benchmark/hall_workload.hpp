#pragma once

#include <cstdint>
#include <vector>

#include "mapping/thermal_map.hpp"
#include "projection/pose.hpp"
#include "tests/benchmark/hall_scene.hpp"

namespace thermovox::bench {

/// What the engines are measured with: a laser of 64 x 1024 beams within +-45 degrees of its horizon flies
/// 100 m at 2 to 6 m height through HallScene and makes 200 scans, each from one place. 1 cm of range noise,
/// nothing beyond 40 m, a temperature for every point: about 65 000 returns a scan, 145 cells of 0.1 m a ray.
class HallWorkload {
 public:
  static constexpr int kScans = 200, kRings = 64, kColumns = 1024;
  static constexpr double kRangeNoise = 0.01, kMaxRange = 40.0;  // metres

  /// Flies; takes a few seconds and 20 bytes a return. Same seed, same returns.
  explicit HallWorkload(std::uint64_t seed = 1);

  /// A scan as the map takes it. Precondition: 0 <= index < kScans.
  [[nodiscard]] std::vector<MappedReturn> scan(int index) const;

 private:
  struct Return {
    Eigen::Vector3f p_world;
    float celsius = 0.0F;
    float incidence = 0.0F;  ///< radians
  };
  struct Scan {
    Pose T_world_laser;
    std::vector<Return> returns;
  };
  [[nodiscard]] static Scan fly(const HallScene& scene, int index, std::uint64_t seed);

  std::vector<Scan> scans_;
};

/// The workload of seed 1, flown once a process.
[[nodiscard]] const HallWorkload& hallWorkload();

}  // namespace thermovox::bench
