#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "projection/cpu_level.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// How many windows LocalVariance looks through.
inline constexpr std::size_t kVarianceLevels = 4;

/// All that colouring reads of one pixel, side by side in memory.
struct Texel {
  std::array<float, kVarianceLevels> variance{};  ///< under each window, C^2
  float celsius = 0.0F;                           ///< NaN where not known
};

/// The image cell a pixel lies in, between the centres of four pixels, and their bilinear weights.
struct ImageCell {
  int column, row;               ///< of the top-left one
  std::array<float, 4> weights;  ///< top left, top right, bottom left, bottom right
};

THERMOVOX_INLINE_LOOP ImageCell imageCellOf(double u, double v) {
  const int truncated_u = static_cast<int>(u), truncated_v = static_cast<int>(v);
  const int column = u < truncated_u ? truncated_u - 1 : truncated_u;
  const int row = v < truncated_v ? truncated_v - 1 : truncated_v;
  const float a = static_cast<float>(u - column);
  const float b = static_cast<float>(v - row);
  return {column, row, {(1.0F - a) * (1.0F - b), a * (1.0F - b), (1.0F - a) * b, a * b}};
}

/// Between which windows an error lies.
struct WindowShares {
  std::array<float, kVarianceLevels - 1> from{};           ///< px^2 beyond the first window, ascending
  std::array<float, kVarianceLevels - 1> inverse_width{};  ///< 1 / px^2

  /// How far an error of `variance_px2` reaches from window i into the next: 0 to 1, and 0 below 0.001.
  [[nodiscard]] THERMOVOX_INLINE_LOOP float of(std::size_t i, float variance_px2) const {
    const float share = (variance_px2 - from[i]) * inverse_width[i];
    const float at_most_one = share < 1.0F ? share : 1.0F;
    return share >= 1e-3F ? at_most_one : 0.0F;
  }
};

/// One step of the variance towards the next window. A larger error is never the surer one, even where a
/// wider window dilutes a small hot spot.
THERMOVOX_INLINE_LOOP float widened(float variance, float share, float wider) {
  const float stepped = variance + share * (wider - variance);
  return stepped > variance ? stepped : variance;
}

/// How much the temperature varies around every pixel, as the variance (C^2) that a position error of a given
/// size makes of it: the image's variance under a Gaussian window, without what the camera's noise alone
/// would show. One level per window; between the levels the variance is linear in the window's variance,
/// which for a constant gradient g is exactly |g|^2 s^2.
class LocalVariance {
 public:
  /// `blur_px` is the smallest window: optics and pixel mix that neighbourhood in any case, and at least the
  /// width of a pixel.
  LocalVariance(const ThermalImage& image, double blur_px, double netd, CpuLevel level = cpuLevel());

  /// Variance (C^2) at the pixel for an error of `variance_px2` (px^2 an axis) beyond the blur.
  [[nodiscard]] float at(const Eigen::Vector2d& pixel, double variance_px2) const;

  [[nodiscard]] const WindowShares& shares() const { return shares_; }
  /// The texels row by row, with one more all around: there the variances are their neighbour's and the
  /// temperature is not known. The texel of pixel (column, row) is the (row + 1) * stride() + column + 1st.
  [[nodiscard]] const Texel* texels() const { return texels_.data(); }
  [[nodiscard]] int stride() const { return width_ + 2; }

 private:
  int width_ = 0;
  int height_ = 0;
  WindowShares shares_;
  std::vector<Texel> texels_;
};

}  // namespace thermovox
