#include "calibration/board_points.hpp"

#include <numeric>

namespace thermovox {
namespace {

/// Which point comes to lie at (column, row) when the grid is turned by a half, or a square one by a quarter.
std::vector<std::size_t> turned(int columns, int rows, int quarters) {
  std::vector<std::size_t> order;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      int from_row = row, from_column = column;
      for (int quarter = 0; quarter < quarters; ++quarter) {
        const int turned_row = columns - 1 - from_column;
        from_column = from_row;
        from_row = turned_row;
      }
      order.push_back(static_cast<std::size_t>(from_row * columns + from_column));
    }
  }
  return order;
}

/// A half turn of a grid of any shape: the points in the opposite order.
std::vector<std::size_t> reversed(std::size_t points) {
  std::vector<std::size_t> order(points);
  for (std::size_t i = 0; i < points; ++i) order[i] = points - 1 - i;
  return order;
}

}  // namespace

std::vector<Eigen::Vector3d> boardPoints(const CalibrationBoard& board) {
  const bool circles = board.pattern == CalibrationBoard::Pattern::asymmetric_circles;
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const int along = circles ? 2 * column + row % 2 : column;
      points.emplace_back(board.square * along, board.square * row, 0.0);
    }
  }
  // The middle of the extent, which is the plate's.
  const double extent = circles ? 2 * board.columns - (board.rows > 1 ? 1 : 2) : board.columns - 1;
  const Eigen::Vector3d middle(0.5 * board.square * extent, 0.5 * board.square * (board.rows - 1), 0.0);
  for (Eigen::Vector3d& point : points) point -= middle;
  return points;
}

std::vector<std::vector<std::size_t>> boardSymmetries(const CalibrationBoard& board) {
  const auto points = static_cast<std::size_t>(board.columns) * static_cast<std::size_t>(board.rows);
  std::vector<std::size_t> same(points);
  std::iota(same.begin(), same.end(), std::size_t{0});
  std::vector<std::vector<std::size_t>> symmetries{same};
  if (board.pattern == CalibrationBoard::Pattern::asymmetric_circles) {
    if (board.rows % 2 == 0) symmetries.push_back(reversed(points));  // the last row is shifted as well
    return symmetries;
  }
  symmetries.push_back(reversed(points));
  if (board.columns == board.rows) {
    for (const int quarters : {1, 3}) symmetries.push_back(turned(board.columns, board.rows, quarters));
  }
  return symmetries;
}

}  // namespace thermovox
