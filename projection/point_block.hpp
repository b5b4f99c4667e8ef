#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "projection/placement.hpp"
#include "projection/projector.hpp"

namespace thermovox {

/// How many points pass through the loops at a time: their columns stay in the nearest cache.
inline constexpr std::size_t kBlockPoints = 128;
/// Loops over a block run to a multiple of this; what lies beyond its size is anything finite or NaN.
inline constexpr std::size_t kBlockStep = 16;

template <typename T>
struct alignas(64) BlockColumn : std::array<T, kBlockPoints> {};

/// Points as columns, with the pixels they project to.
struct PointBlock {
  std::size_t size = 0;
  BlockColumn<double> x{}, y{}, z{};      ///< world, metres
  BlockColumn<double> u{}, v{}, depth{};  ///< px and metres; u is NaN where the point has no pixel
  BlockColumn<std::uint32_t> index{};     ///< which of the points each was before keepProjected

  [[nodiscard]] std::size_t steppedSize() const { return (size + kBlockStep - 1) / kBlockStep * kBlockStep; }

  void set(std::size_t i, const Eigen::Vector3d& p_world) {
    x[i] = p_world.x();
    y[i] = p_world.y();
    z[i] = p_world.z();
  }
};

/// Which pixels count: those of the image, or all that the lens maps to.
enum class Field { image, lens };

/// Fills u, v and depth.
template <LensModel kModel, Field kField>
THERMOVOX_INLINE_LOOP void projectBlock(const Projector& of, PointBlock& block) {
  const Projector projector = of;  // its own copy: the columns that are written cannot be parts of it
  const std::size_t n = block.steppedSize();
  for (std::size_t i = 0; i < n; ++i) {
    const Coordinates3 p = transformed(projector.T_camera_world, block.x[i], block.y[i], block.z[i]);
    const MaybePixel pixel = pixelOf<kModel>(projector.lens, p.x, p.y, p.z);
    const bool counts = kField == Field::image ? pixel.inside : pixel.valid;
    block.u[i] = counts ? pixel.u : std::numeric_limits<double>::quiet_NaN();
    block.v[i] = pixel.v;
    block.depth[i] = p.z;
  }
}

/// Leaves only the points that have a pixel, in their order, and notes which they were. Fills up the last
/// step with the last of them.
THERMOVOX_INLINE_LOOP void keepProjected(PointBlock& block) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < block.size; ++i) {
    for (BlockColumn<double>* column : {&block.x, &block.y, &block.z, &block.u, &block.v, &block.depth})
      (*column)[kept] = (*column)[i];
    block.index[kept] = static_cast<std::uint32_t>(i);
    kept += block.u[kept] == block.u[kept] ? 1 : 0;
  }
  block.size = kept;
  if (kept == 0) return;
  for (std::size_t i = kept; i < block.steppedSize(); ++i) {
    for (BlockColumn<double>* column : {&block.x, &block.y, &block.z, &block.u, &block.v, &block.depth})
      (*column)[i] = (*column)[kept - 1];
  }
}

}  // namespace thermovox
