#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "mapping/thermal_map.hpp"
#include "projection/camera.hpp"
#include "projection/occluder.hpp"

namespace thermovox::test {

/// 160 x 120 pixels over 77 by 62 degrees. In these scenes camera and world are one frame: the camera stands
/// in the origin and looks along z.
[[nodiscard]] inline Camera sceneCamera() {
  Intrinsics in{.width_px = 160, .height_px = 120, .model = LensModel::pinhole};
  in.parameters[kFx] = in.parameters[kFy] = 100.0;
  in.parameters[kCx] = 79.5;
  in.parameters[kCy] = 59.5;
  return Camera(in);
}

/// A rectangle: its corner and two edges, metres.
struct Rectangle {
  Eigen::Vector3d corner, a, b;
};

/// Points of rectangles, 2 cm apart, off their surfaces by the noise of a laser (8 mm).
[[nodiscard]] inline std::vector<Eigen::Vector3d> pointsOf(const std::vector<Rectangle>& rectangles,
                                                           std::uint64_t seed = 5) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> noise(0.0, 0.008);
  std::vector<Eigen::Vector3d> points;
  for (const Rectangle& r : rectangles) {
    const Eigen::Vector3d normal = r.a.cross(r.b).normalized();
    const int rows = static_cast<int>(r.a.norm() / 0.02);
    const int columns = static_cast<int>(r.b.norm() / 0.02);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const Eigen::Vector3d p = r.corner + (i + 0.5) / rows * r.a + (j + 0.5) / columns * r.b;
        points.push_back(p + noise(rng) * normal);
      }
    }
  }
  return points;
}

/// Their map, cells of 5 cm, seen from the origin.
[[nodiscard]] inline ThermalMap mapOf(const std::vector<Rectangle>& rectangles,
                                      Carving carving = Carving::none) {
  std::vector<MappedReturn> reading;
  for (const Eigen::Vector3d& p : pointsOf(rectangles)) {
    reading.push_back({p, Eigen::Vector3d::Zero(), Time{}, std::nullopt});
  }
  ThermalMap map({.resolution = 0.05, .occupancy = {}});
  map.integrate(reading, carving);
  return map;
}

/// A plate of 1 x 1 m across the axis, 2 m ahead; the wall behind it, 5 m ahead, fills the image.
inline const Rectangle kPlate{{-0.5, -0.5, 2.02}, {1, 0, 0}, {0, 1, 0}};
inline const Rectangle kWallBehind{{-5, -4, 5.02}, {10, 0, 0}, {0, 8, 0}};

[[nodiscard]] inline Sight lookAt(const Camera& camera, const Eigen::Vector3d& p) {
  return {Eigen::Vector3d::Zero(), p, camera.projectUnbounded(p).value(), p.z()};
}

}  // namespace thermovox::test
