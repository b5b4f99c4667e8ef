#include "projection/thermal_view.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace thermovox {
std::optional<TemperatureSample> sampleTemperature(const ThermalImage& image, const Eigen::Vector2d& pixel,
                                                   double netd) {
  const double u = std::floor(pixel.x());
  const double v = std::floor(pixel.y());
  const float a = static_cast<float>(pixel.x() - u);
  const float b = static_cast<float>(pixel.y() - v);
  const std::array<float, 4> weights{(1.0F - a) * (1.0F - b), a * (1.0F - b), (1.0F - a) * b, a * b};
  float sum = 0.0F;
  float sum_squared = 0.0F;
  float celsius = 0.0F;
  for (int i = 0; i < 4; ++i) {
    const int column = static_cast<int>(u) + (i & 1);
    const int row = static_cast<int>(v) + (i >> 1);
    if (column < 0 || row < 0 || column >= image.width || row >= image.height) continue;
    const float value = image.at(column, row);
    if (!std::isfinite(value)) continue;
    const float weight = weights[static_cast<std::size_t>(i)];
    sum += weight;
    sum_squared += weight * weight;
    celsius += weight * value;
  }
  if (!(sum >= kLeastKnownWeight)) return std::nullopt;
  return TemperatureSample{celsius / sum, static_cast<float>(netd) * std::sqrt(sum_squared) / sum};
}

ThermalView::ThermalView(ThermalFrame thermal_frame, const Pose& camera_in_world, const ThermalCamera& camera)
    : frame(std::move(thermal_frame)),
      T_world_camera(camera_in_world),
      T_camera_world(camera_in_world.inverse()),
      projector{camera.camera.numbers(), RigidNumbers(T_camera_world)},
      noise(camera.netd * frame.image->noise_gain),
      local_variance(*frame.image, camera.blur_px, noise) {}

}  // namespace thermovox
