#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "calibration/edge_alignment.hpp"

namespace thermovox::test {

/// A warm or cold rectangle that faces the body (across world x), before a wall far behind.
struct Panel {
  double x, y, z;         ///< its middle, metres
  double half_y, half_z;  ///< metres
  double celsius;
};

/// Panels before a wall, seen by a body that turns and moves: images by rays, depth edges from the geometry,
/// so that the truth is known of both.
struct PanelWorld {
  std::vector<Panel> panels{{3.0, -1.2, 0.5, 0.4, 0.5, 30.0}, {4.0, 0.9, -0.6, 0.5, 0.4, 12.0},
                            {5.0, 0.2, 1.0, 0.6, 0.3, 27.0},  {6.0, -1.5, -1.2, 0.7, 0.5, 33.0},
                            {7.0, 2.4, 0.8, 0.8, 0.9, 26.0},  {3.5, 0.1, -0.1, 0.25, 0.2, 40.0}};
  Pose T_body_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.12, -0.03, -0.05}};
  Pose T_body_laser{expRotation({0.01, -0.02, 0.03}), {0.1, 0.05, 0.08}};
  double noise = 0.05;  ///< C
  std::uint64_t seed = 5;

  [[nodiscard]] static Camera camera() {
    Intrinsics intrinsics{.width_px = 80, .height_px = 60};
    intrinsics.parameters = {76.0, 76.0, 39.5, 29.5};
    return Camera(intrinsics);
  }

  [[nodiscard]] static Pose bodyAt(double t) {
    const Eigen::Vector3d turn(0.1 * std::sin(1.1 * t), 0.15 * std::sin(1.7 * t),
                               0.25 * std::sin(1.3 * t + 0.4));
    return {expRotation(turn), {0.3 * std::sin(0.5 * t), 0.5 * std::sin(0.9 * t), 0.2 * std::cos(0.7 * t)}};
  }

  [[nodiscard]] static Time timeOf(double t) { return Time(durationFromSeconds(1000.0 + t)); }

  [[nodiscard]] double temperature(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    double nearest = 1e9, celsius = 20.0;
    for (const Panel& panel : panels) {
      const double distance = (panel.x - origin.x()) / direction.x();
      const Eigen::Vector3d hit = origin + distance * direction;
      const bool inside =
          std::abs(hit.y() - panel.y) < panel.half_y && std::abs(hit.z() - panel.z) < panel.half_z;
      if (distance > 0.0 && distance < nearest && inside) nearest = distance, celsius = panel.celsius;
    }
    return celsius;
  }

  [[nodiscard]] ThermalImage imageAt(double t, std::uint64_t index) const {
    const Camera lens = camera();
    const Pose T_world_camera = bodyAt(t) * T_body_camera;
    std::mt19937_64 random(seed * 1000 + index);
    std::normal_distribution<double> normal(0.0, noise);
    ThermalImage image{.width = lens.width(), .height = lens.height(), .celsius = {}};
    for (int v = 0; v < lens.height(); ++v) {
      for (int u = 0; u < lens.width(); ++u) {
        double sum = 0.0;
        for (int i = 0; i < 25; ++i) {
          const Eigen::Vector2d pixel(u + (i % 5 - 2) * 0.35, v + (i / 5 - 2) * 0.35);  // some blur with it
          sum += temperature(T_world_camera.translation, T_world_camera.rotation * *lens.rayFromPixel(pixel));
        }
        image.celsius.push_back(static_cast<float>(sum / 25 + normal(random)));
      }
    }
    return image;
  }

  /// Of all panels, every 5 cm along their borders, the two beams 2 cm apart.
  [[nodiscard]] std::vector<PlacedEdge> edgesAt(double t) const {
    std::vector<PlacedEdge> edges;
    const Pose T_world_body = bodyAt(t), T_laser_world = (T_world_body * T_body_laser).inverse();
    const auto add = [&](const Eigen::Vector3d& border, const Eigen::Vector3d& outwards) {
      edges.push_back({T_world_body, T_world_body, T_laser_world * Eigen::Vector3d(border - 0.01 * outwards),
                       T_laser_world * Eigen::Vector3d(border + 0.01 * outwards)});
    };
    for (const Panel& p : panels) {
      for (const double side : {-1.0, 1.0}) {
        for (double s = -p.half_z; s <= p.half_z; s += 0.05)
          add({p.x, p.y + side * p.half_y, p.z + s}, {0.0, side, 0.0});
        for (double s = -p.half_y; s <= p.half_y; s += 0.05)
          add({p.x, p.y + s, p.z + side * p.half_z}, {0.0, 0.0, side});
      }
    }
    return edges;
  }

  /// So many frames, 0.2 s apart, as a rig that is true tells them, their stamps late by `late` seconds.
  [[nodiscard]] EdgeScene scene(int frames = 30, double late = 0.0) const {
    std::vector<StampedPose> poses;
    for (int i = -50; i <= 20 * frames + 50; ++i) poses.push_back({timeOf(0.01 * i), bodyAt(0.01 * i)});
    EdgeScene scene{.camera = camera(),
                    .T_body_camera = T_body_camera,
                    .T_body_laser = T_body_laser,
                    .trajectory = Trajectory(poses),
                    .frames = {}};
    for (int i = 0; i < frames; ++i) {
      const double t = 0.2 * i;
      scene.frames.push_back(
          {timeOf(t + late), thermalEdgesOf(imageAt(t, static_cast<std::uint64_t>(i)), 0.05), edgesAt(t)});
    }
    return scene;
  }
};

}  // namespace thermovox::test
