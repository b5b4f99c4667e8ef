#include "calibration/thermal_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thermovox {
namespace {

constexpr int kCellPx = 4;
constexpr double kLeastCosine = 0.5;

/// A picture of numbers; NaN is "not known" and spreads.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;

  [[nodiscard]] float at(int u, int v) const {
    return values[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(u)];
  }
  /// Bilinear. Precondition: inside by one pixel.
  [[nodiscard]] double between(double u, double v) const {
    const int iu = static_cast<int>(u), iv = static_cast<int>(v);
    const double fu = u - iu, fv = v - iv;
    return (1 - fv) * ((1 - fu) * at(iu, iv) + fu * at(iu + 1, iv)) +
           fv * ((1 - fu) * at(iu, iv + 1) + fu * at(iu + 1, iv + 1));
  }
};

std::vector<double> gaussian(double sigma, int order) {
  const int reach = static_cast<int>(std::ceil(3.5 * sigma));
  std::vector<double> kernel;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += order == 0 ? kernel.back() : kernel.back() * i * i;
    if (order == 1) kernel.back() *= i;
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

/// Correlation with a kernel along u or v; the border repeats its last pixel.
Plane filtered(const Plane& plane, const std::vector<double>& kernel, int du, int dv) {
  Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
  const int reach = static_cast<int>(kernel.size()) / 2;
  std::size_t place = 0;
  for (int v = 0; v < plane.height; ++v) {
    for (int u = 0; u < plane.width; ++u) {
      double sum = 0.0;
      for (int k = -reach; k <= reach; ++k) {
        sum +=
            kernel[static_cast<std::size_t>(k + reach)] *
            plane.at(std::clamp(u + k * du, 0, plane.width - 1), std::clamp(v + k * dv, 0, plane.height - 1));
      }
      result.values[place++] = static_cast<float>(sum);
    }
  }
  return result;
}

/// The slope of a smoothed image.
struct Slopes {
  Plane u, v, size;
};

Slopes slopesOf(const ThermalImage& image, double smoothing) {
  const Plane celsius{image.width, image.height, image.celsius};
  const std::vector<double> smooth = gaussian(smoothing, 0), slope = gaussian(smoothing, 1);
  Slopes slopes{.u = filtered(filtered(celsius, slope, 1, 0), smooth, 0, 1),
                .v = filtered(filtered(celsius, smooth, 1, 0), slope, 0, 1),
                .size = celsius};
  for (std::size_t i = 0; i < slopes.size.values.size(); ++i)
    slopes.size.values[i] = std::hypot(slopes.u.values[i], slopes.v.values[i]);
  return slopes;
}

/// The summit of the slope along its own direction, if it lies at this pixel. `noise` is of the slope.
std::optional<ThermalEdge> edgeAt(const Slopes& slopes, int u, int v, double noise) {
  const double size = slopes.size.at(u, v);
  const Eigen::Vector2d normal = Eigen::Vector2d(slopes.u.at(u, v), slopes.v.at(u, v)) / size;
  const double before = slopes.size.between(u - normal.x(), v - normal.y());
  const double after = slopes.size.between(u + normal.x(), v + normal.y());
  if (!(size >= before && size > after)) return std::nullopt;
  const double bend = 2.0 * size - before - after;
  const double offset = 0.5 * (after - before) / bend;
  return ThermalEdge{.pixel = Eigen::Vector2d(u, v) + offset * normal,
                     .normal = normal,
                     .sigma_px = std::min(1.0, noise / bend),
                     .slope = size};
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double imageNoise(const ThermalImage& image) {
  std::vector<double> rest;
  for (int v = 1; v + 1 < image.height; ++v) {
    for (int u = 1; u + 1 < image.width; ++u) {
      const double corners =
          image.at(u - 1, v - 1) + image.at(u + 1, v - 1) + image.at(u - 1, v + 1) + image.at(u + 1, v + 1);
      const double sides = image.at(u - 1, v) + image.at(u + 1, v) + image.at(u, v - 1) + image.at(u, v + 1);
      const double value = std::abs(corners - 2.0 * sides + 4.0 * image.at(u, v));
      if (std::isfinite(value)) rest.push_back(value);
    }
  }
  return rest.empty() ? 0.0 : 1.4826 * median(rest) / 6.0;  // of the mask 1 -2 1 / -2 4 -2 / 1 -2 1
}

ThermalEdges::ThermalEdges(const ThermalImage& image, const Options& options) {
  const double s = options.smoothing_px;
  const double pixel_noise = std::max(options.netd, imageNoise(image));
  const double noise = pixel_noise / (std::sqrt(8.0 * std::numbers::pi) * s * s);
  const Slopes slopes = slopesOf(image, s);
  const int margin = 2 + static_cast<int>(s);
  for (int v = margin; v + margin < image.height; ++v) {
    for (int u = margin; u + margin < image.width; ++u) {
      if (!(slopes.size.at(u, v) > options.least_slope * noise)) continue;
      if (const auto edge = edgeAt(slopes, u, v, noise)) edges_.push_back(*edge);
    }
  }
  sortIntoCells(image.width, image.height);
}

void ThermalEdges::sortIntoCells(int width, int height) {
  columns_ = width / kCellPx + 1, rows_ = height / kCellPx + 1;
  const auto cellOf = [&](const ThermalEdge& edge) {
    const int column = std::clamp(static_cast<int>(edge.pixel.x()) / kCellPx, 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(edge.pixel.y()) / kCellPx, 0, rows_ - 1);
    return static_cast<std::size_t>(row * columns_ + column);
  };
  std::stable_sort(edges_.begin(), edges_.end(),
                   [&](const ThermalEdge& a, const ThermalEdge& b) { return cellOf(a) < cellOf(b); });
  first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const ThermalEdge& edge : edges_) ++first_[cellOf(edge) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

std::optional<ThermalEdge> ThermalEdges::nearest(const Eigen::Vector2d& pixel, const Eigen::Vector2d& along,
                                                 double radius) const {
  const auto cell = [](double px, int count) {
    return std::clamp(static_cast<int>(std::floor(px)) / kCellPx, 0, count - 1);
  };
  const ThermalEdge* best = nullptr;
  double least = radius * radius;
  for (int row = cell(pixel.y() - radius, rows_); row <= cell(pixel.y() + radius, rows_); ++row) {
    const auto line = static_cast<std::size_t>(row * columns_);
    const std::size_t begin = first_[line + static_cast<std::size_t>(cell(pixel.x() - radius, columns_))];
    const std::size_t end = first_[line + static_cast<std::size_t>(cell(pixel.x() + radius, columns_)) + 1];
    for (std::size_t i = begin; i < end; ++i) {
      const double distance = (edges_[i].pixel - pixel).squaredNorm();
      if (!(distance < least) || std::abs(edges_[i].normal.dot(along)) < kLeastCosine) continue;
      least = distance;
      best = &edges_[i];
    }
  }
  return best == nullptr ? std::nullopt : std::optional(*best);
}

}  // namespace thermovox
