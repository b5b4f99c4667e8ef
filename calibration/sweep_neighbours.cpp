#include "calibration/sweep_neighbours.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace thermovox {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Directions in cells of azimuth and elevation.
class DirectionGrid {
 public:
  explicit DirectionGrid(std::span<const LaserReturn> returns) {
    double low = 2.0, high = -2.0, left = 4.0, right = -4.0;
    for (const LaserReturn& r : returns) {
      const double elevation = std::asin(std::clamp(r.p_laser.z() / r.range(), -1.0, 1.0));
      const double azimuth = std::atan2(r.p_laser.y(), r.p_laser.x());
      directions_.emplace_back(azimuth, elevation);
      low = std::min(low, elevation), high = std::max(high, elevation);
      left = std::min(left, azimuth), right = std::max(right, azimuth);
    }
    const double area = std::max(1e-6, right - left) * std::max(1e-3, high - low);
    reach_ = std::clamp(2.0 * std::sqrt(area / static_cast<double>(returns.size())), 1e-3, 0.2);
    columns_ = std::max(1, static_cast<int>(kTurn / reach_));
    lowest_ = low;
    rows_ = static_cast<int>((high - low) / reach_) + 1;
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < directions_.size(); ++i)
      cells_[cell(columnOf(i), rowOf(i))].push_back(static_cast<int>(i));
  }

  [[nodiscard]] SweepNeighbours around(std::size_t i) const {
    SweepNeighbours nearest{-1, -1, -1, -1};
    std::array<double, 4> distance{reach_, reach_, reach_, reach_};
    for (int row = std::max(0, rowOf(i) - 1); row <= std::min(rows_ - 1, rowOf(i) + 1); ++row) {
      for (int column = columnOf(i) - 1; column <= columnOf(i) + 1; ++column) {
        for (const int j : cells_[cell((column + columns_) % columns_, row)]) {
          if (j != static_cast<int>(i)) consider(i, j, nearest, distance);
        }
      }
    }
    return nearest;
  }

 private:
  [[nodiscard]] int columnOf(std::size_t i) const {
    const double share = (directions_[i].x() + std::numbers::pi) / kTurn;
    return std::clamp(static_cast<int>(share * columns_), 0, columns_ - 1);
  }
  [[nodiscard]] int rowOf(std::size_t i) const {
    return std::clamp(static_cast<int>((directions_[i].y() - lowest_) / reach_), 0, rows_ - 1);
  }
  [[nodiscard]] std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void consider(std::size_t i, int j, SweepNeighbours& nearest, std::array<double, 4>& distance) const {
    const Eigen::Vector2d& from = directions_[i];
    Eigen::Vector2d way = directions_[static_cast<std::size_t>(j)] - from;
    way.x() = std::remainder(way.x(), kTurn) * std::cos(from.y());
    const bool level = std::abs(way.x()) >= std::abs(way.y());
    const std::size_t side = level ? (way.x() > 0.0 ? 0 : 2) : (way.y() > 0.0 ? 1 : 3);
    if (!(way.norm() < distance[side])) return;
    distance[side] = way.norm();
    nearest[side] = j;
  }

  std::vector<Eigen::Vector2d> directions_;  ///< azimuth and elevation, radians
  std::vector<std::vector<int>> cells_;
  double reach_ = 0.0;   ///< radians
  double lowest_ = 0.0;  ///< radians
  int columns_ = 0, rows_ = 0;
};

}  // namespace

std::vector<SweepNeighbours> neighboursIn(std::span<const LaserReturn> returns) {
  std::vector<SweepNeighbours> neighbours;
  if (returns.empty()) return neighbours;
  const DirectionGrid grid(returns);
  neighbours.reserve(returns.size());
  for (std::size_t i = 0; i < returns.size(); ++i) neighbours.push_back(grid.around(i));
  return neighbours;
}

}  // namespace thermovox
