#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "projection/camera.hpp"

namespace thermovox::test {

/// A camera of the given size and lens; the distortion in OpenCV's order.
[[nodiscard]] inline Intrinsics intrinsicsOf(LensModel model, const std::vector<double>& distortion,
                                             int width_px = 640, int height_px = 512) {
  Intrinsics in{.width_px = width_px, .height_px = height_px, .model = model};
  in.parameters[kFx] = 0.95 * width_px;
  in.parameters[kFy] = 0.94 * width_px;
  in.parameters[kCx] = 0.49 * width_px;
  in.parameters[kCy] = 0.51 * height_px;
  std::copy(distortion.begin(), distortion.end(), in.parameters.begin() + kDistortion);
  in.distortion_count = static_cast<int>(distortion.size());
  return in;
}

/// A lens as calibrations of thermal cameras give them, strong barrel and pincushion included.
[[nodiscard]] inline Intrinsics randomLens(LensModel model, int distortion_count, std::mt19937_64& random) {
  const auto within = [&](double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(random);
  };
  std::vector<double> d;
  if (model == LensModel::brown_conrady) {
    d = {within(0.45), within(0.2), within(0.005), within(0.005)};
    if (distortion_count > 4) d.push_back(within(0.1));
    if (distortion_count > 5) d.insert(d.end(), {within(0.3), within(0.1), within(0.05)});
  } else if (model == LensModel::kannala_brandt) {
    d = {within(0.1), within(0.05), within(0.02), within(0.01)};
  }
  return intrinsicsOf(model, d);
}

/// A point that the lens maps: within `share` of its valid radius and `widest` (tangent of the angle off the
/// axis), 0.2 to 60 m deep.
[[nodiscard]] inline Eigen::Vector3d randomPoint(const Camera& camera, double share, double widest,
                                                 std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double radius = std::min(share * camera.validRadius(), widest) * std::sqrt(uniform(random));
  const double angle = 2.0 * M_PI * uniform(random);
  const double z = 0.2 + 59.8 * uniform(random);
  return {z * radius * std::cos(angle), z * radius * std::sin(angle), z};
}

/// The lens models with every number of coefficients they take.
struct Lens {
  LensModel model;
  int distortion_count;
  const char* name;
};
inline constexpr Lens kLenses[] = {{LensModel::pinhole, 0, "Pinhole"},
                                   {LensModel::brown_conrady, 4, "BrownConrady4"},
                                   {LensModel::brown_conrady, 5, "BrownConrady5"},
                                   {LensModel::brown_conrady, 8, "BrownConrady8"},
                                   {LensModel::kannala_brandt, 4, "KannalaBrandt"}};

}  // namespace thermovox::test
