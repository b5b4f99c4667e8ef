#include "calibration/corner_refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/NonLinearOptimization>
#include <vector>

namespace thermovox {
namespace {

using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;
constexpr double kWindow = 0.35;     // sigma of the window, squares
constexpr double kReach = 0.7;       // squares that it is cut off at: the next edges begin beyond
constexpr double kLeastReach = 2.0;  // px
constexpr double kMostMoved = 0.35;  // squares from the guess
constexpr double kStandsOut = 3.0;   // sigmas
constexpr std::size_t kFewest = 14;  // pixels for eight unknowns

struct WindowPixel {
  Eigen::Vector2d x;  ///< from the guess, px
  double value;
  double weight;
};

std::vector<WindowPixel> windowAround(const BoardImage& image, const CornerGuess& guess) {
  const double square = std::min(guess.to_next_column.norm(), guess.to_next_row.norm());
  const double reach = std::max(kReach * square, kLeastReach);
  const double sigma = std::max(kWindow * square, 0.5 * kLeastReach);
  std::vector<WindowPixel> window;
  for (int v = static_cast<int>(std::ceil(guess.pixel.y() - reach)); v <= guess.pixel.y() + reach; ++v) {
    for (int u = static_cast<int>(std::ceil(guess.pixel.x() - reach)); u <= guess.pixel.x() + reach; ++u) {
      const Eigen::Vector2d x = Eigen::Vector2d(u, v) - guess.pixel;
      if (x.norm() > reach) continue;
      if (u < 0 || v < 0 || u >= image.width || v >= image.height) return {};
      window.push_back({x, image.at(u, v), std::exp(-x.squaredNorm() / (2.0 * sigma * sigma))});
    }
  }
  return window;
}

/// For Eigen's solver. Unknowns: p, the angles of n1 and n2, c, g, A.
struct CrossProblem {
  const std::vector<WindowPixel>& window;
  double blur;

  [[nodiscard]] int values() const { return static_cast<int>(window.size()); }

  /// One factor erf(t / (sqrt(2) s)) of an edge, and what it changes by with t.
  [[nodiscard]] double edge(double t) const { return std::erf(t / (std::numbers::sqrt2 * blur)); }
  [[nodiscard]] double slope(double t) const {
    return std::sqrt(2.0 / std::numbers::pi) / blur * std::exp(-t * t / (2.0 * blur * blur));
  }

  int operator()(const Eigen::VectorXd& unknowns, Eigen::VectorXd& residuals) const {
    const Eigen::Vector2d n1(std::cos(unknowns[2]), std::sin(unknowns[2]));
    const Eigen::Vector2d n2(std::cos(unknowns[3]), std::sin(unknowns[3]));
    Eigen::Index row = 0;
    for (const WindowPixel& pixel : window) {
      const Eigen::Vector2d d = pixel.x - unknowns.head<2>();
      const double model =
          unknowns[4] + unknowns.segment<2>(5).dot(d) + unknowns[7] * edge(n1.dot(d)) * edge(n2.dot(d));
      residuals[row++] = std::sqrt(pixel.weight) * (model - pixel.value);
    }
    return 0;
  }

  int df(const Eigen::VectorXd& unknowns, Eigen::MatrixXd& jacobian) const {
    const double c1 = std::cos(unknowns[2]), s1 = std::sin(unknowns[2]);
    const double c2 = std::cos(unknowns[3]), s2 = std::sin(unknowns[3]);
    const Eigen::Vector2d n1(c1, s1), n2(c2, s2), m1(-s1, c1), m2(-s2, c2), g = unknowns.segment<2>(5);
    const double a = unknowns[7];
    Eigen::Index row = 0;
    for (const WindowPixel& pixel : window) {
      const Eigen::Vector2d d = pixel.x - unknowns.head<2>();
      const double e1 = edge(n1.dot(d)), e2 = edge(n2.dot(d));
      const double by1 = a * slope(n1.dot(d)) * e2, by2 = a * e1 * slope(n2.dot(d));
      Vector8d derivative;
      derivative << -g - by1 * n1 - by2 * n2, by1 * m1.dot(d), by2 * m2.dot(d), 1.0, d, e1 * e2;
      jacobian.row(row++) = std::sqrt(pixel.weight) * derivative.transpose();
    }
    return 0;
  }
};

/// Normals of the grid's lines: across the way to the next column, and to the next row.
double angleAcross(const Eigen::Vector2d& along) {
  return std::atan2(along.x(), -along.y());
}

Vector8d startOf(const std::vector<WindowPixel>& window, const CornerGuess& guess,
                 const CrossProblem& problem) {
  Vector8d unknowns = Vector8d::Zero();
  unknowns[2] = angleAcross(guess.to_next_column);
  unknowns[3] = angleAcross(guess.to_next_row);
  const Eigen::Vector2d n1(std::cos(unknowns[2]), std::sin(unknowns[2]));
  const Eigen::Vector2d n2(std::cos(unknowns[3]), std::sin(unknowns[3]));
  double weights = 0.0, sum = 0.0, checkered = 0.0, power = 0.0;
  for (const WindowPixel& pixel : window) {
    weights += pixel.weight;
    sum += pixel.weight * pixel.value;
  }
  unknowns[4] = sum / weights;
  for (const WindowPixel& pixel : window) {
    const double sign = problem.edge(n1.dot(pixel.x)) * problem.edge(n2.dot(pixel.x));
    checkered += pixel.weight * sign * (pixel.value - unknowns[4]);
    power += pixel.weight * sign * sign;
  }
  unknowns[7] = checkered / power;
  return unknowns;
}

/// Covariance of a weighted least square whose residuals have one variance: H^-1 (J^T W^2 J) H^-1 with
/// H = J^T W J, times the mean weighted square of the residuals.
std::optional<BoardCorner> cornerOf(const CrossProblem& problem, const Eigen::VectorXd& unknowns,
                                    const CornerGuess& guess) {
  const auto n = static_cast<Eigen::Index>(problem.window.size());
  Eigen::MatrixXd jacobian(n, 8);
  Eigen::VectorXd residuals(n);
  problem(unknowns, residuals);
  problem.df(unknowns, jacobian);
  double weights = 0.0;
  Matrix8d squares = Matrix8d::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double weight = problem.window[static_cast<std::size_t>(i)].weight;
    weights += weight;
    squares += weight * jacobian.row(i).transpose() * jacobian.row(i);
  }
  const Eigen::LDLT<Matrix8d> information(jacobian.transpose() * jacobian);
  if (information.info() != Eigen::Success || !information.isPositive()) return std::nullopt;
  const Matrix8d inverse = information.solve(Matrix8d::Identity());
  // The weights' own share of the freedom that eight unknowns take.
  const double taken = (inverse * squares).trace();
  const double variance = residuals.squaredNorm() / std::max(weights - taken, 1e-3 * weights);
  const Matrix8d covariance = variance * inverse * squares * inverse;
  BoardCorner corner{guess.pixel + unknowns.head<2>(), covariance.topLeftCorner<2, 2>(), 0.0};
  corner.contrast_sigma = std::abs(unknowns[7]) / std::sqrt(std::max(variance, 1e-300));
  if (!corner.covariance.allFinite()) return std::nullopt;
  return corner;
}

}  // namespace

std::optional<BoardCorner> refineCorner(const BoardImage& image, const CornerGuess& guess, double blur_px) {
  if (!guess.pixel.allFinite() || !guess.to_next_column.allFinite() || !guess.to_next_row.allFinite() ||
      !(std::min(guess.to_next_column.norm(), guess.to_next_row.norm()) > 1.0)) {
    return std::nullopt;
  }
  const std::vector<WindowPixel> window = windowAround(image, guess);
  if (window.size() < kFewest) return std::nullopt;
  CrossProblem problem{window, blur_px};
  Eigen::VectorXd unknowns = startOf(window, guess, problem);
  Eigen::LevenbergMarquardt<CrossProblem> solver(problem);
  const auto status = solver.minimize(unknowns);
  const double square = std::min(guess.to_next_column.norm(), guess.to_next_row.norm());
  if (status <= 0 || status == Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation ||
      !unknowns.allFinite() || unknowns.head<2>().norm() > kMostMoved * square) {
    return std::nullopt;
  }
  std::optional<BoardCorner> corner = cornerOf(problem, unknowns, guess);
  if (corner && corner->contrast_sigma < kStandsOut) corner.reset();
  return corner;
}

}  // namespace thermovox
