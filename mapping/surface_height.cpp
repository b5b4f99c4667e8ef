#include "mapping/surface_height.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

constexpr std::size_t kForQuadric = 12;  // points, twice its coefficients

SurfaceHeight meanHeight(const Eigen::VectorXd& heights) {
  const double mean = heights.mean();
  const double n = static_cast<double>(heights.size());
  const double variance = (heights.array() - mean).square().sum() / std::max(n - 1.0, 1.0);
  return {mean, std::sqrt(variance / n)};
}

}  // namespace

std::optional<SurfaceHeight> surfaceHeight(std::span<const Eigen::Vector3d> points,
                                           const Eigen::Vector3d& origin, const Eigen::Vector3d& normal) {
  if (points.empty()) return std::nullopt;
  const Eigen::Vector3d along = normal.unitOrthogonal();
  const Eigen::Vector3d across = normal.cross(along);
  double scale = 1e-9;
  for (const Eigen::Vector3d& p : points) scale = std::max(scale, (p - origin).norm());
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd terms(n, 6);
  Eigen::VectorXd heights(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d d = points[static_cast<std::size_t>(i)] - origin;
    const double u = along.dot(d) / scale, v = across.dot(d) / scale;
    terms.row(i) << 1.0, u, v, u * u, u * v, v * v;
    heights[i] = normal.dot(d);
  }
  if (points.size() < kForQuadric) return meanHeight(heights);
  const Eigen::Matrix<double, 6, 6> normal_matrix = terms.transpose() * terms;
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal_matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-9)) return meanHeight(heights);
  const Eigen::Matrix<double, 6, 1> coefficients = solver.solve(terms.transpose() * heights);
  const double scatter = (heights - terms * coefficients).squaredNorm() / static_cast<double>(n - 6);
  const double share = solver.solve(Eigen::Matrix<double, 6, 1>::Unit(0))[0];
  return SurfaceHeight{coefficients[0], std::sqrt(scatter * share)};
}

}  // namespace thermovox
