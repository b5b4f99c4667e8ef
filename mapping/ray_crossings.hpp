#pragma once

#include <array>
#include <cstdint>

#include "mapping/ray_cells.hpp"
#include "projection/cpu_level.hpp"

namespace thermovox {

/// The cells of a ray without walking it. A walk (RayCells) waits at every step for the one before; here each
/// border that the ray crosses is computed by itself, many at a time: at the k-th border of an axis the ray
/// has come t = t_first + k t_delta far, so that it has crossed floor((t - u_first) / u_delta) + 1 borders of
/// another axis, and these three counts name the cell it enters. The cells are those of the walk, in another
/// order and with the last one: ties (a ray through an edge) are taken in the walk's order by a bias of 1e-9
/// cells, far more than doubles round by and far less than anything measured.
class RayCrossings {
 public:
  /// Cells per axis that a ray may have for this; longer ones are to be walked.
  static constexpr std::int32_t kLongest = (1 << 15) - 64;  // so that tiles differ by less than 512
  static constexpr int kChunk = 256;

  /// The cells of up to kChunk crossings as codes: which tile, 10 bits of each of its coordinates (they tell
  /// the tiles of one ray apart), and which cell in it: CellPlace::in_tile.
  struct Codes {
    alignas(64) std::array<std::uint32_t, kChunk> tile;
    alignas(64) std::array<std::uint32_t, kChunk> cell;
  };

  explicit RayCrossings(const RayCells& ray, CpuLevel level = cpuLevel());

  [[nodiscard]] bool isTooLong() const { return too_long_; }

  /// Calls visit(codes, count) until every cell that the ray enters has been in; not the one it begins in.
  template <typename Visitor>
  void forEachChunk(Codes& codes, Visitor&& visit) const {
    for (const Axis& axis : axes_) {
      for (std::int32_t k = 0; k < axis.count; k += kChunk) {
        const int count = axis.count - k < kChunk ? axis.count - k : kChunk;
        compute_(axis, k, count, codes);
        visit(static_cast<const Codes&>(codes), count);
      }
    }
  }

  /// What it takes to compute the crossings of one axis (0) and of the other two (1, 2) at them.
  struct Axis {
    std::int32_t count = 0;  ///< borders that the ray crosses
    double t_first = 0.0, t_delta = 0.0;
    struct Other {
      double per_t = 0.0, offset = 0.0;  ///< borders crossed at t: trunc(t * per_t + offset), at most `most`
      std::int32_t most = 0;
    };
    std::array<Other, 2> others;
    std::array<std::int32_t, 3> first{};  ///< the cell where the ray begins, own axis first
    std::array<std::int32_t, 3> step{};
    std::array<std::int32_t, 3> number{};  ///< which of x, y, z they are
  };

 private:
  using Compute = void (*)(const Axis&, std::int32_t first_crossing, int count, Codes&);
  std::array<Axis, 3> axes_;
  Compute compute_;
  bool too_long_ = false;
};

/// The tile that a code of RayCrossings means, near another tile of the same ray.
[[nodiscard]] inline TileKey tileOfCode(std::uint32_t code, const TileKey& near) {
  const auto coordinate = [&](int shift, std::int32_t base) {
    const auto ahead = (((code >> shift) - static_cast<std::uint32_t>(base)) & 1023U) << 22;
    return base + (static_cast<std::int32_t>(ahead) >> 22);
  };
  return {coordinate(0, near.x), coordinate(10, near.y), coordinate(20, near.z)};
}

}  // namespace thermovox
