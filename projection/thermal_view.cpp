#include "projection/thermal_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace thermovox {
namespace {

/// Windows beyond the blur, as factors of its variance: errors from a fraction of a pixel to several.
constexpr std::array<double, 4> kWindowFactors{1.0, 4.0, 16.0, 64.0};
/// Of a pixel's own width, px^2: no optics mix less than that.
constexpr double kPixelVariance = 1.0 / 12.0;

/// Double, because the variance is the small difference of two large numbers: in floats a flat wall in the
/// image of a furnace would vary by more than the camera's noise.
using Plane = std::vector<double>;

std::vector<double> gaussianKernel(double sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3.0 * sigma)));
  std::vector<double> kernel;
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) sum += std::exp(-0.5 * i * i / (sigma * sigma));
  for (int i = -radius; i <= radius; ++i) {
    kernel.push_back(std::exp(-0.5 * i * i / (sigma * sigma)) / sum);
  }
  return kernel;
}

/// Convolution along one axis of a width x height plane; the border repeats.
Plane convolveRows(const Plane& plane, int width, int height, const std::vector<double>& kernel) {
  const int radius = static_cast<int>(kernel.size()) / 2;
  Plane result(plane.size());
  Plane padded(static_cast<std::size_t>(width + 2 * radius));
  for (int v = 0; v < height; ++v) {
    const double* row = plane.data() + static_cast<std::ptrdiff_t>(v) * width;
    for (int i = 0; i < width + 2 * radius; ++i)
      padded[static_cast<std::size_t>(i)] = row[std::clamp(i - radius, 0, width - 1)];
    double* out = result.data() + static_cast<std::ptrdiff_t>(v) * width;
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      for (int u = 0; u < width; ++u) out[u] += kernel[k] * padded[static_cast<std::size_t>(u) + k];
    }
  }
  return result;
}

Plane convolveColumns(const Plane& plane, int width, int height, const std::vector<double>& kernel) {
  const int radius = static_cast<int>(kernel.size()) / 2;
  Plane result(plane.size());
  for (int v = 0; v < height; ++v) {
    double* out = result.data() + static_cast<std::ptrdiff_t>(v) * width;
    for (int k = -radius; k <= radius; ++k) {
      const double* row =
          plane.data() + static_cast<std::ptrdiff_t>(std::clamp(v + k, 0, height - 1)) * width;
      const double weight = kernel[static_cast<std::size_t>(k + radius)];
      for (int u = 0; u < width; ++u) out[u] += weight * row[u];
    }
  }
  return result;
}

struct Moments {
  Plane weight, first, second;  ///< known pixels as 0 or 1, their values, their squares
};

Moments momentsOf(const ThermalImage& image) {
  Moments moments;
  for (const float celsius : image.celsius) {
    const bool known = std::isfinite(celsius);
    const double value = known ? celsius : 0.0;
    moments.weight.push_back(known ? 1.0 : 0.0);
    moments.first.push_back(value);
    moments.second.push_back(value * value);
  }
  return moments;
}

std::vector<float> windowedVariance(const ThermalImage& image, const Moments& moments, double sigma,
                                    double netd) {
  const std::vector<double> kernel = gaussianKernel(sigma);
  const auto blur = [&](const Plane& plane) {
    return convolveColumns(convolveRows(plane, image.width, image.height, kernel), image.width, image.height,
                           kernel);
  };
  const Plane weight = blur(moments.weight);
  const Plane first = blur(moments.first);
  const Plane second = blur(moments.second);
  double squared_weights = 0.0;  // of the kernel in 2D: what is left of the noise's variance after averaging
  for (const double k : kernel) squared_weights += k * k;
  squared_weights *= squared_weights;
  const double noise = netd * netd * (1.0 - squared_weights);
  std::vector<float> variance(first.size(), 0.0F);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (weight[i] < 1e-3) continue;
    const double mean = first[i] / weight[i];
    variance[i] = static_cast<float>(std::max(0.0, second[i] / weight[i] - mean * mean - noise));
  }
  return variance;
}

/// Bilinear read of a plane without unknowns; the border repeats.
float readPlane(const std::vector<float>& plane, int width, int height, const Eigen::Vector2d& pixel) {
  const double u = std::clamp(pixel.x(), 0.0, static_cast<double>(width - 1));
  const double v = std::clamp(pixel.y(), 0.0, static_cast<double>(height - 1));
  const int u0 = std::min(static_cast<int>(u), std::max(0, width - 2));
  const int v0 = std::min(static_cast<int>(v), std::max(0, height - 2));
  const int right = width > 1 ? 1 : 0;
  const int below = height > 1 ? width : 0;
  const float a = static_cast<float>(u - u0);
  const float b = static_cast<float>(v - v0);
  const float* p = plane.data() + static_cast<std::ptrdiff_t>(v0) * width + u0;
  return (1.0F - b) * ((1.0F - a) * p[0] + a * p[right]) + b * ((1.0F - a) * p[below] + a * p[below + right]);
}

}  // namespace

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
  constexpr float kLeastWeight = 0.5F;
  if (!(sum >= kLeastWeight)) return std::nullopt;
  return TemperatureSample{celsius / sum, static_cast<float>(netd) * std::sqrt(sum_squared) / sum};
}

LocalVariance::LocalVariance(const ThermalImage& image, double blur_px, double netd)
    : width_(image.width), height_(image.height) {
  const Moments moments = momentsOf(image);
  const double least_px2 = std::max(blur_px * blur_px, kPixelVariance);
  for (const double factor : kWindowFactors) {
    const double window_px2 = factor * least_px2;
    levels_.push_back({window_px2, windowedVariance(image, moments, std::sqrt(window_px2), netd)});
  }
}

float LocalVariance::at(const Eigen::Vector2d& pixel, double variance_px2) const {
  const double window = levels_.front().window_px2 + variance_px2;
  float variance = readPlane(levels_.front().variance, width_, height_, pixel);
  for (std::size_t i = 1; i < levels_.size() && levels_[i - 1].window_px2 < window; ++i) {
    const Level& below = levels_[i - 1];
    const double share =
        std::min(1.0, (window - below.window_px2) / (levels_[i].window_px2 - below.window_px2));
    if (share < 1e-3) break;
    const float wider = readPlane(levels_[i].variance, width_, height_, pixel);
    // A larger error is never the surer one, even where a wider window dilutes a small hot spot.
    variance = std::max(variance, variance + static_cast<float>(share) * (wider - variance));
  }
  return variance;
}

ThermalView::ThermalView(ThermalFrame thermal_frame, const Pose& camera_in_world, const ThermalCamera& camera)
    : frame(std::move(thermal_frame)),
      T_world_camera(camera_in_world),
      T_camera_world(camera_in_world.inverse()),
      local_variance(*frame.image, camera.blur_px, camera.netd) {}

}  // namespace thermovox
