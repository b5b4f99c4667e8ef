#include "mapping/local_plane.hpp"

#include <Eigen/Eigenvalues>

namespace thermovox {

LocalPlane localPlane(const PointSums& sums, double thickness) {
  const auto count = static_cast<double>(sums.count);
  const Eigen::Vector3d mean = sums.first / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(sums.second / count - mean * mean.transpose());
  const Eigen::Vector3d& variances = solver.eigenvalues();
  if (!(variances[0] < thickness * thickness * variances[1])) return {};
  return {solver.eigenvectors().col(0).cast<float>(), variances[1]};
}

}  // namespace thermovox
