#include "mapping/local_plane.hpp"

#include <Eigen/Eigenvalues>

namespace thermovox {
namespace {

constexpr double kPlanar = 0.35;  // thickness of a plane against its shorter width

}  // namespace

LocalPlane localPlane(const PointSums& sums) {
  const auto count = static_cast<double>(sums.count);
  const Eigen::Vector3d mean = sums.first / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(sums.second / count - mean * mean.transpose());
  const Eigen::Vector3d& variances = solver.eigenvalues();
  if (!(variances[0] < kPlanar * kPlanar * variances[1])) return {};
  return {solver.eigenvectors().col(0).cast<float>(), variances[1]};
}

}  // namespace thermovox
