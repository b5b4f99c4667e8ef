#include "apps/simulate/visible_render.hpp"

#include <cmath>

namespace thermovox::simulate {
namespace {

constexpr double kPanel = 0.6;         // metres
constexpr double kSeam = 0.012;        // metres on either side of where two panels meet
constexpr double kInto = 0.001;        // metres: a surface where two layers of panels meet belongs to one
constexpr int kSamplesAlongPixel = 2;  // rays a pixel and axis

/// A grey from 0 to 1 that belongs to a panel: an integer hash (the finaliser of MurmurHash3, A. Appleby).
double greyOf(const Eigen::Vector3i& panel) {
  auto bits = static_cast<std::uint32_t>(panel.x() * 73856093 ^ panel.y() * 19349663 ^ panel.z() * 83492791);
  bits = (bits ^ bits >> 16) * 0x85EBCA6BU;
  bits = (bits ^ bits >> 13) * 0xC2B2AE35U;
  return static_cast<double>((bits ^ bits >> 16) & 0xFFFFU) / 65535.0;
}

double luminanceOf(const Hit& hit, const Eigen::Vector3d& p_world) {
  // The origin of the panels is nowhere that surfaces of the hall begin.
  const Eigen::Vector3d place = (p_world - kInto * hit.normal) / kPanel + Eigen::Vector3d(0.37, 0.21, 0.43);
  const Eigen::Vector3i panel = place.array().floor().cast<int>();
  const Eigen::Vector3d light = Eigen::Vector3d(0.45, 0.3, 0.84).normalized();
  double shade = 0.55 + 0.45 * std::abs(hit.normal.dot(light));
  for (int axis = 0; axis < 3; ++axis) {
    const double seam_distance = kPanel * std::abs(place[axis] - std::round(place[axis]));
    if (std::abs(hit.normal[axis]) < 0.7 && seam_distance < kSeam) shade *= 0.45;
  }
  return 255.0 * shade * (0.45 + 0.5 * greyOf(panel));
}

}  // namespace

std::vector<std::uint8_t> renderVisible(const Hall& hall, const Camera& camera, const Pose& T_world_camera) {
  const Eigen::Matrix3d R_world_camera = T_world_camera.matrix();
  const auto seenAlong = [&](const Eigen::Vector2d& pixel) {
    const auto ray = camera.rayFromPixel(pixel);
    if (!ray) return 0.0;
    const Eigen::Vector3d d_world = (R_world_camera * *ray).normalized();
    const auto hit = hall.castRay(T_world_camera.translation, d_world);
    return hit ? luminanceOf(*hit, T_world_camera.translation + hit->range * d_world) : 0.0;
  };
  std::vector<std::uint8_t> luminance;
  for (int v = 0; v < camera.height(); ++v) {
    for (int u = 0; u < camera.width(); ++u) {
      double sum = 0.0;
      for (int i = 0; i < kSamplesAlongPixel * kSamplesAlongPixel; ++i) {
        const Eigen::Vector2d sample(i % kSamplesAlongPixel, i / kSamplesAlongPixel);
        sum += seenAlong(Eigen::Vector2d(u - 0.5, v - 0.5) +
                         (sample + Eigen::Vector2d(0.5, 0.5)) / kSamplesAlongPixel);
      }
      luminance.push_back(
          static_cast<std::uint8_t>(std::lround(sum / (kSamplesAlongPixel * kSamplesAlongPixel))));
    }
  }
  return luminance;
}

}  // namespace thermovox::simulate
