#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "projection/local_variance.hpp"
#include "projection/point_block.hpp"
#include "projection/thermal_view.hpp"

namespace thermovox {

/// The loops of ColouringBatch, in their order. After keepProjected they are about the points in the image.
struct ColouringBlock {
  PointBlock points;
  std::array<BlockColumn<float>, 6> covariance{};  ///< of each point: xx xy xz yy yz zz, world, m^2
  BlockColumn<float> x{}, y{}, inverse_depth{};    ///< in the camera: X / Z, Y / Z, 1 / Z
  BlockColumn<float> range{};                      ///< camera to point, metres
  BlockColumn<std::int32_t> texel{};               ///< number of the image cell's top-left texel
  std::array<BlockColumn<float>, 4> weights{};     ///< of the cell's corners
  std::array<BlockColumn<float>, 4> corners{};     ///< their temperatures
  std::array<BlockColumn<float>, kVarianceLevels> variance{};    ///< at the pixel, under each window
  std::array<BlockColumn<float>, kVarianceLevels - 1> shares{};  ///< how far the error reaches to the next
  BlockColumn<float> celsius{};                                  ///< NaN where not known
  BlockColumn<float> noise{};                                    ///< of the sample, one sigma, C
  BlockColumn<float> sigma{};
  BlockColumn<std::uint8_t> hidden{};
};

/// Where each pixel lies in the texels.
THERMOVOX_INLINE_LOOP void findCells(ColouringBlock& block, int stride) {
  const std::size_t n = block.points.steppedSize();
  for (std::size_t i = 0; i < n; ++i) {
    const ImageCell cell = imageCellOf(block.points.u[i], block.points.v[i]);
    block.texel[i] = (cell.row + 1) * stride + cell.column + 1;
    for (std::size_t k = 0; k < 4; ++k) block.weights[k][i] = cell.weights[k];
  }
}

/// What each point's place errs by in the image, as shares of the variance's windows.
template <LensModel kModel>
THERMOVOX_INLINE_LOOP void findErrors(ColouringBlock& block, const Projector& of, const WindowShares& from) {
  const RigidNumbers T_camera_world = of.T_camera_world;  // copies: see projectBlock
  const ErrorProjector projector(of);
  const WindowShares windows = from;
  const std::size_t n = block.points.steppedSize();
  for (std::size_t i = 0; i < n; ++i) {
    const Coordinates3 p =
        transformed(T_camera_world, block.points.x[i], block.points.y[i], block.points.z[i]);
    block.x[i] = static_cast<float>(p.x / p.z);
    block.y[i] = static_cast<float>(p.y / p.z);
    block.inverse_depth[i] = static_cast<float>(1.0 / p.z);
    block.range[i] = static_cast<float>(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto& c = block.covariance;
    const float variance_px2 =
        pixelVariance<kModel>(projector, block.x[i], block.y[i], block.inverse_depth[i],
                              {c[0][i], c[1][i], c[2][i], c[3][i], c[4][i], c[5][i]});
    for (std::size_t k = 0; k < windows.from.size(); ++k) block.shares[k][i] = windows.of(k, variance_px2);
  }
}

/// Reads the texels: the one loop that jumps about in memory.
THERMOVOX_INLINE_LOOP void readTemperatures(ColouringBlock& block, const Texel* texels, int stride) {
  for (std::size_t i = 0; i < block.points.size; ++i) {
    const Texel* above = texels + block.texel[i];
    const Texel* below = above + stride;
    block.corners[0][i] = above[0].celsius;
    block.corners[1][i] = above[1].celsius;
    block.corners[2][i] = below[0].celsius;
    block.corners[3][i] = below[1].celsius;
  }
}
THERMOVOX_INLINE_LOOP void readVariances(ColouringBlock& block, const Texel* texels, int stride) {
  const auto& w = block.weights;
  for (std::size_t i = 0; i < block.points.size; ++i) {
    const Texel* above = texels + block.texel[i];
    const Texel* below = above + stride;
    for (std::size_t k = 0; k < kVarianceLevels; ++k) {
      block.variance[k][i] = w[0][i] * above[0].variance[k] + w[1][i] * above[1].variance[k] +
                             w[2][i] * below[0].variance[k] + w[3][i] * below[1].variance[k];
    }
  }
}

/// The bilinear temperatures and their noise; see sampleTemperature.
THERMOVOX_INLINE_LOOP void sampleCorners(ColouringBlock& block, float netd) {
  const std::size_t n = block.points.steppedSize();
  for (std::size_t i = 0; i < n; ++i) {
    float sum = 0.0F, sum_squared = 0.0F, celsius = 0.0F;
    for (std::size_t k = 0; k < 4; ++k) {
      const float value = block.corners[k][i];
      const bool known = std::abs(value) <= std::numeric_limits<float>::max();
      const float weight = known ? block.weights[k][i] : 0.0F;
      sum += weight;
      sum_squared += weight * weight;
      celsius += weight * (known ? value : 0.0F);
    }
    const float mean = celsius / sum;
    block.celsius[i] = sum >= kLeastKnownWeight ? mean : std::numeric_limits<float>::quiet_NaN();
    block.noise[i] = netd * std::sqrt(sum_squared) / sum;
  }
}

/// Sigma from the noise and the variance that the place's error makes of the image.
THERMOVOX_INLINE_LOOP void sumErrors(ColouringBlock& block) {
  const std::size_t n = block.points.steppedSize();
  for (std::size_t i = 0; i < n; ++i) {
    float variance = block.variance[0][i];
    for (std::size_t k = 1; k < kVarianceLevels; ++k)
      variance = widened(variance, block.shares[k - 1][i], block.variance[k][i]);
    block.sigma[i] = std::sqrt(block.noise[i] * block.noise[i] + variance);
  }
}

/// Puts the air on the way to each point into its temperature and sigma.
THERMOVOX_INLINE_LOOP void correctForAir(ColouringBlock& block, const AirPath& of) {
  const AirPath air = of;  // a copy: see projectBlock
  const std::size_t n = block.points.steppedSize();
  for (std::size_t i = 0; i < n; ++i) {
    const AirPath::Corrected corrected = air.at(block.celsius[i], block.range[i]);
    block.celsius[i] = static_cast<float>(corrected.celsius);
    block.sigma[i] *= static_cast<float>(corrected.slope);
  }
}

}  // namespace thermovox
