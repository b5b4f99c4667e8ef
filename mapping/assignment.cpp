#include "mapping/assignment.hpp"

#include <algorithm>
#include <limits>

namespace thermovox {
namespace {

constexpr int kNone = -1;

/// Assigns every row of a matrix with at least as many columns as rows.
class ShortestPaths {
 public:
  explicit ShortestPaths(const Eigen::MatrixXd& costs)
      : costs_(costs),
        of_row_(Eigen::VectorXd::Zero(costs.rows())),
        of_column_(Eigen::VectorXd::Zero(costs.cols())),
        row_of_(static_cast<std::size_t>(costs.cols()), kNone) {}

  std::vector<int> solve() {
    for (int row = 0; row < costs_.rows(); ++row) augment(row);
    std::vector<int> column_of(static_cast<std::size_t>(costs_.rows()), kNone);
    for (int j = 0; j < costs_.cols(); ++j) {
      if (rowOf(j) != kNone) column_of[static_cast<std::size_t>(rowOf(j))] = j;
    }
    return column_of;
  }

 private:
  [[nodiscard]] int& rowOf(int column) { return row_of_[static_cast<std::size_t>(column)]; }

  /// Dijkstra over reduced costs from a free row to the nearest free column, and the path turned over.
  void augment(int start) {
    const auto columns = static_cast<int>(costs_.cols());
    Eigen::VectorXd distance = Eigen::VectorXd::Constant(columns, std::numeric_limits<double>::infinity());
    std::vector<int> before(static_cast<std::size_t>(columns), kNone);
    std::vector<bool> done(static_cast<std::size_t>(columns));
    std::vector<int> reached;
    int row = start, last = kNone;
    double walked = 0.0;
    while (true) {
      int nearest = kNone;
      for (int j = 0; j < columns; ++j) {
        if (done[static_cast<std::size_t>(j)]) continue;
        const double through = walked + costs_(row, j) - of_row_[row] - of_column_[j];
        if (through < distance[j]) {
          distance[j] = through;
          before[static_cast<std::size_t>(j)] = last;
        }
        if (nearest == kNone || distance[j] < distance[nearest]) nearest = j;
      }
      walked = distance[nearest];
      done[static_cast<std::size_t>(nearest)] = true;
      reached.push_back(nearest);
      last = nearest;
      if (rowOf(nearest) == kNone) break;
      row = rowOf(nearest);
    }
    of_row_[start] += walked;
    for (const int j : reached) {
      if (rowOf(j) != kNone) of_row_[rowOf(j)] += walked - distance[j];
      of_column_[j] -= walked - distance[j];
    }
    for (int j = last; j != kNone;) {
      const int previous = before[static_cast<std::size_t>(j)];
      rowOf(j) = previous == kNone ? start : rowOf(previous);
      j = previous;
    }
  }

  const Eigen::MatrixXd& costs_;
  Eigen::VectorXd of_row_, of_column_;  ///< potentials
  std::vector<int> row_of_;
};

}  // namespace

std::vector<std::optional<int>> assign(const Eigen::MatrixXd& costs, double limit) {
  const auto rows = costs.rows(), columns = costs.cols();
  std::vector<std::optional<int>> assigned(static_cast<std::size_t>(rows));
  if (rows == 0) return assigned;
  // A column of its own for every row that stays alone.
  Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(rows, columns + rows);
  wide.leftCols(columns) = (costs.array() - limit).min(0.0);
  const std::vector<int> solution = ShortestPaths(wide).solve();
  for (Eigen::Index i = 0; i < rows; ++i) {
    const int column = solution[static_cast<std::size_t>(i)];
    if (column < columns && costs(i, column) < limit) assigned[static_cast<std::size_t>(i)] = column;
  }
  return assigned;
}

}  // namespace thermovox
