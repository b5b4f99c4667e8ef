#include "mapping/surface_height.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mapping/plane_basis.hpp"

namespace thermovox {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
constexpr double kSure = 3.0;            // sigmas
constexpr std::size_t kForQuadric = 12;  // columns, twice its coefficients

/// Returns over one place: their mean along the plane and off it, and how many.
struct Column {
  Eigen::Vector3d uvh = Eigen::Vector3d::Zero();
  double returns = 0.0;
};

std::vector<Column> columnsOf(std::span<const HeightPoint> points, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& normal, double edge) {
  Eigen::Matrix3d to_plane;
  to_plane << planeBasis(normal).transpose(), normal.transpose();
  std::map<std::pair<int, int>, Column> columns;
  for (const HeightPoint& point : points) {
    const Eigen::Vector3d uvh = to_plane * (point.p_world - origin);
    Column& column =
        columns[{static_cast<int>(std::floor(uvh.x() / edge)), static_cast<int>(std::floor(uvh.y() / edge))}];
    column.uvh += point.returns * uvh;
    column.returns += point.returns;
  }
  std::vector<Column> result;
  for (const auto& [place, column] : columns) result.push_back({column.uvh / column.returns, column.returns});
  return result;
}

/// Variance of what is estimated with so many degrees of freedom by a scatter (sum of squares) that is itself
/// estimated: that of Student's t.
double studentVariance(double squares, double freedom) {
  return squares / std::max(freedom - 2.0, 1.0);
}

SurfaceHeight meanHeight(const std::vector<Column>& columns, const Eigen::Vector3d& normal) {
  double sum = 0.0, weights = 0.0, squares = 0.0;
  for (const Column& column : columns) {
    sum += column.returns * column.uvh.z();
    weights += column.returns;
  }
  const double mean = sum / weights;
  for (const Column& column : columns) squares += column.returns * std::pow(column.uvh.z() - mean, 2);
  return {mean, std::sqrt(studentVariance(squares, static_cast<double>(columns.size()) - 1.0) / weights),
          normal, 0.0};
}

/// The larger one of a quadric; 0 where the noise of its coefficients may have made it.
double curvatureOf(const Vector6d& coefficients, const Matrix6d& covariance) {
  Eigen::Matrix2d bend;  // second derivatives
  bend << 2.0 * coefficients[3], coefficients[4], coefficients[4], 2.0 * coefficients[5];
  const double curvature =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(bend).eigenvalues().cwiseAbs().maxCoeff();
  const double variance = 4.0 * std::max(covariance(3, 3), covariance(5, 5));
  return curvature > kSure * std::sqrt(variance) ? curvature : 0.0;
}

}  // namespace

std::optional<SurfaceHeight> surfaceHeight(std::span<const HeightPoint> points, const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& normal, double edge) {
  if (points.empty()) return std::nullopt;
  const std::vector<Column> columns = columnsOf(points, origin, normal, edge);
  if (columns.size() < kForQuadric) return meanHeight(columns, normal);
  double scale = 1e-9;
  for (const Column& column : columns) scale = std::max(scale, column.uvh.head<2>().norm());
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd terms(n, 6);
  Eigen::VectorXd heights(n);
  for (Eigen::Index i = 0; i < n; ++i) {  // by the root of the weight
    const Column& column = columns[static_cast<std::size_t>(i)];
    const double u = column.uvh.x() / scale, v = column.uvh.y() / scale;
    const double root = std::sqrt(column.returns);
    terms.row(i) << 1.0, u, v, u * u, u * v, v * v;
    terms.row(i) *= root;
    heights[i] = root * column.uvh.z();
  }
  const Matrix6d normal_matrix = terms.transpose() * terms;
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal_matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-9)) return meanHeight(columns, normal);
  const Vector6d coefficients = solver.solve(terms.transpose() * heights);
  const double scatter =
      studentVariance((heights - terms * coefficients).squaredNorm(), static_cast<double>(n - 6));
  const double share = solver.solve(Eigen::Matrix<double, 6, 1>::Unit(0))[0];
  const Eigen::Vector3d slope = planeBasis(normal) * coefficients.segment<2>(1) / scale;
  return SurfaceHeight{
      coefficients[0], std::sqrt(scatter * share), (normal - slope).normalized(),
      curvatureOf(coefficients, scatter * solver.solve(Matrix6d::Identity())) / (scale * scale)};
}

}  // namespace thermovox
