#include "projection/local_variance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thermovox {
namespace {

/// Windows beyond the blur, as factors of its variance: errors from a fraction of a pixel to several.
constexpr std::array<double, kVarianceLevels> kWindowFactors{1.0, 4.0, 16.0, 64.0};
/// Of a pixel's own width, px^2: no optics mix less than that.
constexpr double kPixelVariance = 1.0 / 12.0;

/// A plane of doubles. Double, because the variance is the
/// small difference of two large numbers: in floats a flat wall in the image of a furnace would vary by more
/// than the camera's noise.
struct Plane {
  std::size_t width;
  std::vector<double> values;

  Plane(int width, int height)
      : width(static_cast<std::size_t>(width)), values(this->width * static_cast<std::size_t>(height)) {}
  [[nodiscard]] double* row(int v) { return values.data() + static_cast<std::size_t>(v) * width; }
  [[nodiscard]] const double* row(int v) const { return values.data() + static_cast<std::size_t>(v) * width; }
};

/// e^-x for 0 <= x < 10, in arithmetic alone: the C library's own differs between processors in its last bit.
double expOfMinus(double x) {
  const double t = x / 64.0;
  double e = 1.0;
  for (int i = 9; i > 0; --i) e = 1.0 - t / i * e;  // Taylor's series of e^-t, from its end
  for (int i = 0; i < 6; ++i) e *= e;
  return e;
}

/// The right half of a Gaussian that is cut off at three sigmas, its middle first; the whole sums to 1.
std::vector<double> gaussianHalf(double sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3.0 * sigma)));
  std::vector<double> kernel;
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i) {
    kernel.push_back(expOfMinus(0.5 * i * i / (sigma * sigma)));
    sum += (i == 0 ? 1.0 : 2.0) * kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

/// How many weights of a kernel are taken in one passage over a row.
constexpr std::size_t kTapsAtOnce = 4;

/// What a row is summed from: for each weight the rows on either side (in the middle twice the same one, with
/// half of its weight). A multiple of kTapsAtOnce, filled up with zero weights.
struct Taps {
  std::vector<double> weights;
  std::vector<std::array<const double*, 2>> rows;

  explicit Taps(const std::vector<double>& kernel)
      : weights((kernel.size() + kTapsAtOnce - 1) / kTapsAtOnce * kTapsAtOnce, 0.0), rows(weights.size()) {
    std::copy(kernel.begin(), kernel.end(), weights.begin());
    weights[0] *= 0.5;
  }
  /// Sets the rows of the kernel's weight k, and those of the zeros after the last.
  void set(std::size_t k, const double* one_side, const double* other_side) {
    std::fill(rows.begin() + static_cast<std::ptrdiff_t>(k), rows.end(), std::array{one_side, other_side});
  }
};

THERMOVOX_INLINE_LOOP void sumTapsLoop(const Taps& taps, double* __restrict out, std::size_t size) {
  std::fill_n(out, size, 0.0);
  for (std::size_t k = 0; k < taps.weights.size(); k += kTapsAtOnce) {
    const double w0 = taps.weights[k], w1 = taps.weights[k + 1], w2 = taps.weights[k + 2],
                 w3 = taps.weights[k + 3];
    const auto [a0, b0] = taps.rows[k];
    const auto [a1, b1] = taps.rows[k + 1];
    const auto [a2, b2] = taps.rows[k + 2];
    const auto [a3, b3] = taps.rows[k + 3];
    for (std::size_t u = 0; u < size; ++u) {
      out[u] += (w0 * (a0[u] + b0[u]) + w1 * (a1[u] + b1[u])) + (w2 * (a2[u] + b2[u]) + w3 * (a3[u] + b3[u]));
    }
  }
}
void sumTapsBaseline(const Taps& taps, double* out, std::size_t size) {
  sumTapsLoop(taps, out, size);
}
THERMOVOX_TARGET_AVX2 void sumTapsAvx2(const Taps& taps, double* out, std::size_t size) {
  sumTapsLoop(taps, out, size);
}
THERMOVOX_TARGET_AVX512 void sumTapsAvx512(const Taps& taps, double* out, std::size_t size) {
  sumTapsLoop(taps, out, size);
}

/// Blurs a plane by the windows; the border repeats.
class Blur {
 public:
  Blur(int width, int height, CpuLevel level) : width_(width), height_(height), level_(level) {}

  [[nodiscard]] Plane operator()(const Plane& plane, const std::vector<double>& kernel) const {
    return alongColumns(alongRows(plane, kernel), kernel);
  }

 private:
  void sum(const Taps& taps, double* out, std::size_t size) const {
    if (level_ == CpuLevel::avx512) return sumTapsAvx512(taps, out, size);
    if (level_ == CpuLevel::avx2) return sumTapsAvx2(taps, out, size);
    sumTapsBaseline(taps, out, size);
  }

  [[nodiscard]] Plane alongRows(const Plane& plane, const std::vector<double>& kernel) const {
    const std::size_t radius = kernel.size() - 1;
    Plane result(width_, height_);
    std::vector<double> padded(plane.width + 2 * radius);
    Taps taps(kernel);
    for (std::size_t k = 0; k <= radius; ++k)
      taps.set(k, padded.data() + radius - k, padded.data() + radius + k);
    for (int v = 0; v < height_; ++v) {
      const double* row = plane.row(v);
      const auto inside = padded.begin() + static_cast<std::ptrdiff_t>(radius);
      std::fill(padded.begin(), inside, row[0]);
      std::fill(std::copy_n(row, plane.width, inside), padded.end(), row[plane.width - 1]);
      sum(taps, result.row(v), plane.width);
    }
    return result;
  }

  [[nodiscard]] Plane alongColumns(const Plane& plane, const std::vector<double>& kernel) const {
    Plane result(width_, height_);
    Taps taps(kernel);
    for (int v = 0; v < height_; ++v) {
      for (int k = 0; k < static_cast<int>(kernel.size()); ++k) {
        taps.set(static_cast<std::size_t>(k), plane.row(std::max(v - k, 0)),
                 plane.row(std::min(v + k, height_ - 1)));
      }
      sum(taps, result.row(v), plane.width);
    }
    return result;
  }

  int width_;
  int height_;
  CpuLevel level_;
};

struct Moments {
  Plane weight, first, second;  ///< known pixels as 0 or 1, their values, their squares
  bool all_known = true;
};

Moments momentsOf(const ThermalImage& image) {
  Moments moments{Plane(image.width, image.height), Plane(image.width, image.height),
                  Plane(image.width, image.height)};
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const float celsius = image.at(u, v);
      const bool known = std::isfinite(celsius);
      const double value = known ? celsius : 0.0;
      moments.weight.row(v)[u] = known ? 1.0 : 0.0;
      moments.first.row(v)[u] = value;
      moments.second.row(v)[u] = value * value;
      moments.all_known = moments.all_known && known;
    }
  }
  return moments;
}

/// What the window leaves of the variance of noise that is independent from pixel to pixel, as a factor: 1
/// less the squared weights of the kernel in two dimensions.
double noiseLeft(const std::vector<double>& kernel) {
  double squared_weights = 0.0;
  for (std::size_t k = 0; k < kernel.size(); ++k)
    squared_weights += (k == 0 ? 1.0 : 2.0) * kernel[k] * kernel[k];
  return 1.0 - squared_weights * squared_weights;
}

}  // namespace

LocalVariance::LocalVariance(const ThermalImage& image, double blur_px, double netd, CpuLevel level)
    : width_(image.width), height_(image.height) {
  const Blur blur(width_, height_, level);
  const Moments moments = momentsOf(image);
  const double least_px2 = std::max(blur_px * blur_px, kPixelVariance);
  texels_.resize(static_cast<std::size_t>(width_ + 2) * static_cast<std::size_t>(height_ + 2));
  for (std::size_t i = 0; i < kVarianceLevels; ++i) {
    const double window_px2 = kWindowFactors[i] * least_px2;
    const std::vector<double> kernel = gaussianHalf(std::sqrt(window_px2));
    const Plane first = blur(moments.first, kernel);
    const Plane second = blur(moments.second, kernel);
    const Plane weight = moments.all_known ? moments.weight : blur(moments.weight, kernel);
    const double noise = netd * netd * noiseLeft(kernel);
    for (int v = -1; v <= height_; ++v) {
      const int row = std::clamp(v, 0, height_ - 1);
      Texel* out = texels_.data() + static_cast<std::ptrdiff_t>(v + 1) * stride() + 1;
      for (int u = -1; u <= width_; ++u) {
        const int column = std::clamp(u, 0, width_ - 1);
        const double share = weight.row(row)[column];
        const double mean = first.row(row)[column] / share;
        const double variance = second.row(row)[column] / share - mean * mean - noise;
        out[u].variance[i] = share < 1e-3 ? 0.0F : static_cast<float>(std::max(0.0, variance));
      }
    }
    if (i + 1 < kVarianceLevels) {
      shares_.from[i] = static_cast<float>((kWindowFactors[i] - 1.0) * least_px2);
      shares_.inverse_width[i] =
          static_cast<float>(1.0 / ((kWindowFactors[i + 1] - kWindowFactors[i]) * least_px2));
    }
  }
  for (Texel& texel : texels_) texel.celsius = std::numeric_limits<float>::quiet_NaN();
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u)
      texels_[static_cast<std::size_t>((v + 1) * stride() + u + 1)].celsius = image.at(u, v);
  }
}

float LocalVariance::at(const Eigen::Vector2d& pixel, double variance_px2) const {
  const double u = std::clamp(pixel.x(), -0.5, width_ - 0.5);
  const double v = std::clamp(pixel.y(), -0.5, height_ - 0.5);
  const ImageCell cell = imageCellOf(u, v);
  const Texel* above = texels() + static_cast<std::ptrdiff_t>(cell.row + 1) * stride() + cell.column + 1;
  const Texel* below = above + stride();
  const auto& w = cell.weights;
  const auto level = [&](std::size_t i) {
    return w[0] * above[0].variance[i] + w[1] * above[1].variance[i] + w[2] * below[0].variance[i] +
           w[3] * below[1].variance[i];
  };
  float variance = level(0);
  for (std::size_t i = 1; i < kVarianceLevels; ++i)
    variance = widened(variance, shares_.of(i - 1, static_cast<float>(variance_px2)), level(i));
  return variance;
}

}  // namespace thermovox
