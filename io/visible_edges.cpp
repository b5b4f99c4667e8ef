#include "io/visible_edges.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace thermovox {
namespace {

constexpr std::uint8_t kCovered = 255;

/// Pixels of the visible picture from one thermal pixel to the next, in the middle of those that have one.
double spacing(const PixelMap& map) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < map.pixels.size(); ++i) {
    const double step = (map.pixels[i] - map.pixels[i - 1]).norm();
    if (std::isfinite(step)) steps.push_back(step);
  }
  if (steps.empty()) return 1.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// The luminance, smoothed so that one sample in `step` pixels misses nothing.
cv::Mat smoothedFor(const VisiblePicture& picture, double step) {
  cv::Mat luminance(picture.height, picture.width, CV_8U);
  std::copy(picture.luminance.begin(), picture.luminance.end(), luminance.begin<std::uint8_t>());
  constexpr double coarsest = 32.0;  // pixels; beyond it a record is damaged, and the kernel without bound
  if (step > 1.5) cv::GaussianBlur(luminance, luminance, {}, 0.4 * std::min(step, coarsest));
  return luminance;
}

/// Bilinear between the centres of the pixels; nullopt outside of them.
std::optional<double> sample(const cv::Mat& luminance, const Eigen::Vector2d& pixel) {
  if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= luminance.cols - 1 &&
        pixel.y() <= luminance.rows - 1))
    return std::nullopt;
  const int u = std::min(static_cast<int>(pixel.x()), luminance.cols - 2);
  const int v = std::min(static_cast<int>(pixel.y()), luminance.rows - 2);
  const double right = pixel.x() - u, down = pixel.y() - v;
  const auto* upper = luminance.ptr<std::uint8_t>(v) + u;
  const auto* lower = luminance.ptr<std::uint8_t>(v + 1) + u;
  return (1.0 - down) * ((1.0 - right) * upper[0] + right * upper[1]) +
         down * ((1.0 - right) * lower[0] + right * lower[1]);
}

}  // namespace

PixelMap pixelsByRecord(const PictureInPicture& record, const RawThermalImage& thermal,
                        const VisiblePicture& visible) {
  PixelMap map{.width = thermal.width, .height = thermal.height};
  const double step = visible.width / record.real_to_ir / thermal.width;
  const Eigen::Vector2d centre(0.5 * (visible.width - 1) + record.offset_x,
                               0.5 * (visible.height - 1) + record.offset_y);
  const Eigen::Vector2d thermal_centre(0.5 * (thermal.width - 1), 0.5 * (thermal.height - 1));
  for (int v = 0; v < thermal.height; ++v) {
    for (int u = 0; u < thermal.width; ++u)
      map.pixels.emplace_back(centre + step * (Eigen::Vector2d(u, v) - thermal_centre));
  }
  return map;
}

ResampledPicture resample(const RegisteredPicture& visible, int zoom) {
  const PixelMap& map = visible.pixels;
  ResampledPicture resampled{.width = map.width * zoom, .height = map.height * zoom};
  const auto size = static_cast<std::size_t>(resampled.width) * static_cast<std::size_t>(resampled.height);
  resampled.luminance.assign(size, 0);
  resampled.covered.assign(size, 0);
  if (std::min({map.width, map.height, visible.picture.width, visible.picture.height}) < 2) return resampled;
  const cv::Mat luminance = smoothedFor(visible.picture, spacing(map) / zoom);
  std::size_t i = 0;
  for (int y = 0; y < resampled.height; ++y) {
    for (int x = 0; x < resampled.width; ++x, ++i) {
      const Eigen::Vector2d thermal((x + 0.5) / zoom - 0.5, (y + 0.5) / zoom - 0.5);
      const auto value = sample(luminance, map.at(thermal));
      if (!value) continue;
      resampled.luminance[i] = static_cast<std::uint8_t>(std::lround(*value));
      resampled.covered[i] = kCovered;
    }
  }
  return resampled;
}

}  // namespace thermovox
