#include "mapping/assignment.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>
#include <set>

namespace thermovox {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The least sum of (cost - limit) over all ways to pair rows from `row` on with the columns that are left.
double leastCost(const Eigen::MatrixXd& costs, double limit, int row, std::set<int>& taken) {
  if (row == costs.rows()) return 0.0;
  double least = leastCost(costs, limit, row + 1, taken);  // alone
  for (int column = 0; column < costs.cols(); ++column) {
    if (costs(row, column) == kInfinity || !taken.insert(column).second) continue;
    least = std::min(least, costs(row, column) - limit + leastCost(costs, limit, row + 1, taken));
    taken.erase(column);
  }
  return least;
}

double costOf(const Eigen::MatrixXd& costs, double limit, const std::vector<std::optional<int>>& assigned) {
  double sum = 0.0;
  std::set<int> taken;
  for (std::size_t row = 0; row < assigned.size(); ++row) {
    if (!assigned[row]) continue;
    EXPECT_TRUE(taken.insert(*assigned[row]).second) << "column " << *assigned[row] << " twice";
    sum += costs(static_cast<Eigen::Index>(row), *assigned[row]) - limit;
  }
  return sum;
}

TEST(Assign, CostsAsLittleAsTheBestOfAllPermutations) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> cost(0.0, 10.0);
  std::uniform_int_distribution<int> size(1, 6), coin(0, 9);
  for (int i = 0; i < 2000; ++i) {
    Eigen::MatrixXd costs(size(random), size(random));
    for (double& c : costs.reshaped()) c = coin(random) == 0 ? kInfinity : cost(random);
    if (i % 4 == 0) costs = costs.array().round();  // many ways that are equally good
    const double limit = i % 3 == 0 ? 100.0 : 5.0;
    SCOPED_TRACE(testing::Message() << "matrix " << i << ":\n" << costs);
    const auto assigned = assign(costs, limit);
    ASSERT_EQ(assigned.size(), static_cast<std::size_t>(costs.rows()));
    std::set<int> taken;
    // Sums of six numbers below 100: their last bits.
    ASSERT_NEAR(costOf(costs, limit, assigned), leastCost(costs, limit, 0, taken), 1e-9);
  }
}

TEST(Assign, MakesNoPairThatCostsMoreThanTheLimit) {
  const Eigen::Matrix2d costs{{1.0, 9.0}, {9.0, 8.0}};
  EXPECT_THAT(assign(costs, 5.0), testing::ElementsAre(std::optional(0), std::nullopt));
  EXPECT_THAT(assign(costs, 8.5), testing::ElementsAre(std::optional(0), std::optional(1)));
}

TEST(Assign, PrefersTheSumToTheNearest) {
  // The first row's nearest is the only one that the second can have.
  const Eigen::Matrix2d costs{{1.0, 2.0}, {1.5, kInfinity}};
  EXPECT_THAT(assign(costs, 5.0), testing::ElementsAre(std::optional(1), std::optional(0)));
}

TEST(Assign, LeavesAllAloneWhereThereIsNothingToPair) {
  EXPECT_THAT(assign(Eigen::MatrixXd(0, 3), 5.0), testing::IsEmpty());
  EXPECT_THAT(assign(Eigen::MatrixXd(2, 0), 5.0), testing::ElementsAre(std::nullopt, std::nullopt));
  EXPECT_THAT(assign(Eigen::MatrixXd::Constant(2, 2, kInfinity), 5.0),
              testing::ElementsAre(std::nullopt, std::nullopt));
}

TEST(Assign, FindsAPlantedPairingOfHundreds) {
  constexpr int kMany = 300;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> far(5.0, 50.0), near(0.0, 1.0);
  std::vector<int> planted(kMany);
  for (int i = 0; i < kMany; ++i) planted[static_cast<std::size_t>(i)] = i;
  std::shuffle(planted.begin(), planted.end(), random);
  Eigen::MatrixXd costs(kMany, kMany);
  for (double& c : costs.reshaped()) c = far(random);
  for (int i = 0; i < kMany; ++i) costs(i, planted[static_cast<std::size_t>(i)]) = near(random);
  const auto assigned = assign(costs, 16.27);
  for (int i = 0; i < kMany; ++i) {
    ASSERT_EQ(assigned[static_cast<std::size_t>(i)], planted[static_cast<std::size_t>(i)]);
  }
}

}  // namespace
}  // namespace thermovox
