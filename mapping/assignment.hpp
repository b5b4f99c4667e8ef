#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace thermovox {

/// For each row of a matrix of costs the column that it is assigned to, or none, so that the sum of the costs
/// is the least: each column once at most, and a row or column that is left alone costs nothing while a pair
/// costs its entry less `limit`, so that no pair that costs more than the limit is made. By shortest
/// augmenting paths with potentials (Jonker and Volgenant 1987), in cubic time.
[[nodiscard]] std::vector<std::optional<int>> assign(const Eigen::MatrixXd& costs, double limit);

}  // namespace thermovox
