#include "mapping/ray_crossings.hpp"

#include <algorithm>

namespace thermovox {
namespace {

constexpr double kTie = 1e-9;  // cells
constexpr int kCellsPerTileBits = kBlockBits + kTileBits;

/// Whether a walk that stands before borders of both axes at the same distance crosses `other` first.
bool crossesFirst(int other, int own) {
  return other > own;  // z before y before x, as OctoMap's comparisons have it
}

RayCrossings::Axis::Other otherAxis(const RayCells& ray, int own, int other, std::int32_t most) {
  const auto axis = static_cast<std::size_t>(other);
  if (most == 0) return {};
  const double per_t = 1.0 / ray.fromBorderToBorder()[axis];
  const double tie = crossesFirst(other, own) ? kTie : -kTie;
  return {per_t, 1.0 - ray.toFirstBorder()[axis] * per_t + tie, most};
}

/// A coordinate's part of a cell's code: its place in the block, and its block's place in the tile.
THERMOVOX_INLINE_LOOP std::uint32_t cellPart(std::int32_t k) {
  const auto bits = static_cast<std::uint32_t>(k);
  return (bits & 7U) | ((bits & 56U) << 6);
}
THERMOVOX_INLINE_LOOP std::uint32_t tilePart(std::int32_t k) {
  return static_cast<std::uint32_t>(k >> kCellsPerTileBits) & 1023U;
}

/// Borders of another axis that are crossed at t: from 0 to `most`, also where a ray that is all but parallel
/// to them makes t huge, negative or not a number.
THERMOVOX_INLINE_LOOP std::int32_t crossed(double t, const RayCrossings::Axis::Other& other) {
  const double borders = t * other.per_t + other.offset;
  const auto most = static_cast<double>(other.most);
  const double at_most = borders < most ? borders : most;
  return static_cast<std::int32_t>(at_most > 0.0 ? at_most : 0.0);
}

THERMOVOX_INLINE_LOOP void compute(const RayCrossings::Axis& axis, std::int32_t first_crossing, int count,
                                   RayCrossings::Codes& codes) {
  const auto [own, b, c] = axis.number;
  const RayCrossings::Axis::Other other_b = axis.others[0], other_c = axis.others[1];
  const std::int32_t own_first = axis.first[0], b_first = axis.first[1], c_first = axis.first[2];
  const std::int32_t own_step = axis.step[0], b_step = axis.step[1], c_step = axis.step[2];
  std::uint32_t* tiles = codes.tile.data();
  std::uint32_t* cells = codes.cell.data();
  const double t_first = axis.t_first, t_delta = axis.t_delta;
  for (int i = 0; i < count; ++i) {
    const std::int32_t k = first_crossing + i;
    const double t = t_first + static_cast<double>(k) * t_delta;
    const std::int32_t own_cell = own_first + own_step * (k + 1);
    const std::int32_t b_cell = b_first + b_step * crossed(t, other_b);
    const std::int32_t c_cell = c_first + c_step * crossed(t, other_c);
    tiles[i] = (tilePart(own_cell) << 10 * own) | (tilePart(b_cell) << 10 * b) | (tilePart(c_cell) << 10 * c);
    cells[i] = (cellPart(own_cell) << 3 * own) | (cellPart(b_cell) << 3 * b) | (cellPart(c_cell) << 3 * c);
  }
}

void computeBaseline(const RayCrossings::Axis& axis, std::int32_t first, int count,
                     RayCrossings::Codes& codes) {
  compute(axis, first, count, codes);
}
THERMOVOX_TARGET_AVX2 void computeAvx2(const RayCrossings::Axis& axis, std::int32_t first, int count,
                                       RayCrossings::Codes& codes) {
  compute(axis, first, count, codes);
}
THERMOVOX_TARGET_AVX512 void computeAvx512(const RayCrossings::Axis& axis, std::int32_t first, int count,
                                           RayCrossings::Codes& codes) {
  compute(axis, first, count, codes);
}

}  // namespace

RayCrossings::RayCrossings(const RayCells& ray, CpuLevel level) {
  compute_ =
      level == CpuLevel::avx512 ? computeAvx512 : (level == CpuLevel::avx2 ? computeAvx2 : computeBaseline);
  const CellKey first_key = ray.first(), last_key = ray.last();
  const std::array<std::int32_t, 3> first{first_key.x, first_key.y, first_key.z};
  const std::array<std::int32_t, 3> last{last_key.x, last_key.y, last_key.z};
  std::array<std::int32_t, 3> borders{};
  for (std::size_t i = 0; i < 3; ++i) {
    // A ray that ends on a border may lie in the cell behind by rounding, against its own direction.
    borders[i] = std::max((last[i] - first[i]) * ray.step()[i], 0);
    too_long_ = too_long_ || borders[i] > kLongest;
  }
  for (int own = 0; own < 3; ++own) {
    const int b = (own + 1) % 3, c = (own + 2) % 3;
    Axis& axis = axes_[static_cast<std::size_t>(own)];
    axis.number = {own, b, c};
    for (std::size_t i = 0; i < 3; ++i) {
      axis.first[i] = first[static_cast<std::size_t>(axis.number[i])];
      axis.step[i] = ray.step()[static_cast<std::size_t>(axis.number[i])];
    }
    axis.count = borders[static_cast<std::size_t>(own)];
    axis.t_first = ray.toFirstBorder()[static_cast<std::size_t>(own)];
    axis.t_delta = ray.fromBorderToBorder()[static_cast<std::size_t>(own)];
    axis.others = {otherAxis(ray, own, b, borders[static_cast<std::size_t>(b)]),
                   otherAxis(ray, own, c, borders[static_cast<std::size_t>(c)])};
  }
}

}  // namespace thermovox
