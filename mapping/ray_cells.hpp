#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mapping/cell_key.hpp"

namespace thermovox {

/// Calls visit(key) for the cells that a ray passes from the cell of `origin` up to, but without, the cell of
/// `end`; for none when both lie in one cell. Amanatides and Woo 1987, in the very arithmetic of OctoMap's
/// computeRayKeys (float points and direction, double distances, its rule for rays that miss their last cell
/// by rounding), so that the cells are OctoMap's also on cell borders and diagonals. Rays beyond OctoMap's
/// reach are walked near the origin of the world, shifted by whole cells, where floats still tell cells
/// apart.
class RayCells {
 public:
  /// Metres, world. Precondition: finite and within kMaxCellKey.
  RayCells(const Eigen::Vector3d& origin, const Eigen::Vector3d& end, double resolution);

  template <typename Visitor>
  void forEach(Visitor&& visit) const {
    if (first_ == last_) return;
    Index cell = first_;
    std::array<double, 3> t_max = t_max_;
    visit(keyOf(cell));
    while (length_ > 0.0F) {  // false for rays too short for a float
      const int axis = t_max[0] < t_max[1] ? (t_max[0] < t_max[2] ? 0 : 2) : (t_max[1] < t_max[2] ? 1 : 2);
      cell[axis] += step_[axis];
      t_max[axis] += t_delta_[axis];
      if (cell == last_) break;
      if (std::min(std::min(t_max[0], t_max[1]), t_max[2]) > length_) break;
      visit(keyOf(cell));
    }
  }

  using Index = std::array<std::int32_t, 3>;
  /// The cell where the ray begins, and where it ends.
  [[nodiscard]] CellKey first() const { return keyOf(first_); }
  [[nodiscard]] CellKey last() const { return keyOf(last_); }
  /// Per axis: the way the ray goes (-1, 0, 1), the distance along it to the first border it crosses and from
  /// border to border (metres; huge where it goes no way).
  [[nodiscard]] const Index& step() const { return step_; }
  [[nodiscard]] const std::array<double, 3>& toFirstBorder() const { return t_max_; }
  [[nodiscard]] const std::array<double, 3>& fromBorderToBorder() const { return t_delta_; }

 private:
  [[nodiscard]] CellKey keyOf(const Index& cell) const {
    return {cell[0] + shift_[0], cell[1] + shift_[1], cell[2] + shift_[2]};
  }

  Index shift_{};  ///< cells from the origin of the world to that of the walk
  Index first_{};
  Index last_{};
  Index step_{};
  std::array<double, 3> t_max_{};    ///< distance to the next border on each axis, metres
  std::array<double, 3> t_delta_{};  ///< distance from border to border, metres
  float length_ = 0.0F;              ///< metres
};

// Implementation

inline RayCells::RayCells(const Eigen::Vector3d& origin, const Eigen::Vector3d& end, double resolution) {
  const double inverse = 1.0 / resolution;
  Eigen::Vector3d near_origin = origin;
  Eigen::Vector3d near_end = end;
  for (int i = 0; i < 3; ++i) {
    if (std::max(std::abs(origin[i]), std::abs(end[i])) * inverse < kOctomapReach) continue;
    shift_[i] = cellIndex(origin[i], inverse);
    near_origin[i] -= shift_[i] * resolution;
    near_end[i] -= shift_[i] * resolution;
  }
  const Eigen::Vector3f from = near_origin.cast<float>();
  const Eigen::Vector3f to = near_end.cast<float>();
  Eigen::Vector3f direction = to - from;
  const float squared =
      direction.x() * direction.x() + direction.y() * direction.y() + direction.z() * direction.z();
  length_ = static_cast<float>(std::sqrt(static_cast<double>(squared)));
  for (int i = 0; i < 3; ++i) {
    direction[i] /= length_;
    first_[i] = static_cast<std::int32_t>(std::floor(inverse * static_cast<double>(from[i])));
    last_[i] = static_cast<std::int32_t>(std::floor(inverse * static_cast<double>(to[i])));
    step_[i] = direction[i] > 0.0F ? 1 : (direction[i] < 0.0F ? -1 : 0);
    t_max_[i] = t_delta_[i] = std::numeric_limits<double>::max();
    if (step_[i] == 0) continue;
    const double border = (first_[i] + 0.5) * resolution + static_cast<float>(step_[i] * resolution * 0.5);
    t_max_[i] = (border - static_cast<double>(from[i])) / static_cast<double>(direction[i]);
    t_delta_[i] = resolution / std::abs(static_cast<double>(direction[i]));
  }
}

}  // namespace thermovox
