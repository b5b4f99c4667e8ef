#include "calibration/laser_verdict.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "calibration/bundle_statistics.hpp"

namespace thermovox {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTolerableTurn = 0.2 * kDegree;
constexpr double kTolerableShift = 0.005;  // metres
constexpr double kJackknifeWins = 2.0;     // times the covariance's sigmas: what no model has errs

/// From the tangent of the bundle to (w, v) along the reference camera's axes.
Eigen::MatrixXd publishedFromTangent(const RigEstimate& estimate, int laser_size) {
  const int turns = laser_size - 3;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(6, laser_size);
  G.topLeftCorner(3, turns) = estimate.T_reference_laser.matrix().rightCols(turns);
  G.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity();
  return G;
}

/// Rays that a laser of the kind sends where the reference camera may look.
std::vector<Eigen::Vector3d> raysOfKind(LaserKind kind) {
  if (kind == LaserKind::beam) return {Eigen::Vector3d::UnitX()};
  std::vector<Eigen::Vector3d> rays;
  const double highest = kind == LaserKind::scan ? 0.0 : 60.0;
  for (double up = -highest; up <= highest; up += 5.0) {
    for (double left = -180.0; left < 180.0; left += kind == LaserKind::scan ? 1.0 : 5.0) {
      const double a = left * kDegree, e = up * kDegree;
      rays.emplace_back(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    }
  }
  return rays;
}

/// Laser and lens of the reference camera, moved along the tangent: what pixel transfer depends on.
struct TransferModel {
  const RigEstimate& estimate;
  const std::vector<int>& free_intrinsics;
  int laser_size;

  [[nodiscard]] std::optional<Eigen::Vector2d> pixel(const Eigen::Vector3d& p_laser,
                                                     const Eigen::VectorXd& tangent) const {
    const int turns = laser_size - 3;
    Eigen::Vector3d w = Eigen::Vector3d::Zero();
    w.tail(turns) = tangent.head(turns);
    const Pose moved{estimate.T_reference_laser.rotation * expRotation(w),
                     estimate.T_reference_laser.translation + tangent.segment<3>(turns)};
    Intrinsics lens = estimate.cameras.front();
    for (std::size_t i = 0; i < free_intrinsics.size(); ++i) {
      lens.parameters[static_cast<std::size_t>(free_intrinsics[i])] +=
          tangent[laser_size + static_cast<Eigen::Index>(i)];
    }
    return Camera(lens).projectUnbounded(moved * p_laser);
  }
};

/// Mean variance of the pixel, both coordinates together, over the rays that the image sees.
std::optional<double> transferVariance(const TransferModel& model, const Eigen::MatrixXd& covariance,
                                       const std::vector<Eigen::Vector3d>& rays, double distance) {
  const Camera lens(model.estimate.cameras.front());
  const Eigen::Index n = covariance.rows();
  double sum = 0.0;
  int count = 0;
  for (const Eigen::Vector3d& ray : rays) {
    const Eigen::Vector3d p = distance * ray;
    if (!lens.project(model.estimate.T_reference_laser * p)) continue;
    Eigen::MatrixXd J(2, n);
    bool complete = true;
    for (Eigen::Index i = 0; i < n && complete; ++i) {
      const double step = 0.01 * std::sqrt(std::max(covariance(i, i), 1e-16));
      const auto ahead = model.pixel(p, step * Eigen::VectorXd::Unit(n, i));
      const auto behind = model.pixel(p, -step * Eigen::VectorXd::Unit(n, i));
      complete = ahead && behind;
      if (complete) J.col(i) = (*ahead - *behind) / (2.0 * step);
    }
    if (!complete) continue;
    sum += (J * covariance * J.transpose()).trace();
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

/// What one capture says of the unknowns that all captures share, its own eliminated.
struct SharedInformation {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

SharedInformation sharedInformation(const Linearisation& linear, int capture, int shared) {
  std::vector<Eigen::Index> own;
  if (capture >= 0) {
    const auto place = static_cast<std::size_t>(capture);
    if (linear.layout.range_bias[place] >= 0) own.push_back(linear.layout.range_bias[place]);
    for (int i = 0; i < 6 && linear.layout.board[place] >= 0; ++i)
      own.push_back(linear.layout.board[place] + i);
  }
  const auto owned = static_cast<Eigen::Index>(own.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(shared + owned, shared + owned);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(shared + owned);
  for (const RowGroup& group : linear.groups) {
    if (group.capture != capture) continue;
    const Eigen::MatrixXd rows = linear.jacobian.middleRows(group.first, group.count);
    Eigen::MatrixXd J(group.count, shared + owned);
    J << rows.leftCols(shared), rows(Eigen::all, own);
    A += J.transpose() * J;
    g += J.transpose() * linear.residuals.segment(group.first, group.count);
  }
  if (owned == 0) return {A, g};
  const Eigen::LDLT<Eigen::MatrixXd> own_information(Eigen::MatrixXd(A.bottomRightCorner(owned, owned)));
  const Eigen::MatrixXd across = A.bottomLeftCorner(owned, shared);
  return {A.topLeftCorner(shared, shared) - across.transpose() * own_information.solve(across),
          g.head(shared) - across.transpose() * own_information.solve(Eigen::VectorXd(g.tail(owned)))};
}

/// Sigmas of the laser's tangent when the captures are left out one at a time (one Gauss-Newton step each).
Eigen::VectorXd jackknifeSigmas(const Linearisation& linear, int captures) {
  int shared = linear.layout.size;
  for (const std::vector<int>* own : {&linear.layout.range_bias, &linear.layout.board}) {
    for (const int place : *own) {
      if (place >= 0) shared = std::min(shared, place);
    }
  }
  std::vector<SharedInformation> parts;
  SharedInformation all = sharedInformation(linear, -1, shared);
  for (int capture = 0; capture < captures; ++capture) {
    parts.push_back(sharedInformation(linear, capture, shared));
    all.information += parts.back().information;
  }
  std::vector<Eigen::VectorXd> moves;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(linear.layout.laser_size);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (linear.layout.range_bias[i] < 0) continue;
    const Eigen::LDLT<Eigen::MatrixXd> rest(all.information - parts[i].information);
    moves.push_back(rest.solve(parts[i].gradient).head(linear.layout.laser_size));
    mean += moves.back();
  }
  const auto n = static_cast<double>(moves.size());
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(linear.layout.laser_size);
  for (const Eigen::VectorXd& move : moves) squares += (move - mean / n).cwiseAbs2();
  return ((n - 1.0) / n * squares).cwiseSqrt();
}

/// One sigma each of what is tolerable.
Eigen::VectorXd tolerances(Eigen::Index size) {
  Eigen::VectorXd result = Eigen::VectorXd::Constant(size, kTolerableTurn);
  result.tail<3>().setConstant(kTolerableShift);
  return result;
}

/// Places of the laser and of the reference camera's lens among the unknowns.
std::vector<Eigen::Index> transferUnknowns(const TangentLayout& layout, std::size_t lens) {
  std::vector<Eigen::Index> places;
  for (int i = 0; i < layout.laser_size; ++i) places.push_back(i);
  for (std::size_t i = 0; i < lens && layout.intrinsics.front() >= 0; ++i)
    places.push_back(layout.intrinsics.front() + static_cast<Eigen::Index>(i));
  return places;
}

}  // namespace

LaserVerdict laserVerdict(const Linearisation& linear, const Eigen::MatrixXd& covariance,
                          const RigEstimate& estimate, const LaserVerdictInput& input) {
  LaserVerdict verdict;
  const int size = linear.layout.laser_size;
  verdict.observable = true;
  verdict.roll_observable = input.kind != LaserKind::beam;
  const Eigen::MatrixXd laser = covariance.topLeftCorner(size, size);
  const Eigen::MatrixXd G = publishedFromTangent(estimate, size);
  verdict.covariance = G * laser * G.transpose();
  const Eigen::VectorXd scale = tolerances(size).cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      Eigen::MatrixXd(scale.asDiagonal() * laser * scale.asDiagonal()));
  const double largest = eigen.eigenvalues()[size - 1];
  verdict.condition = largest / eigen.eigenvalues()[0];
  verdict.weakest_share = std::sqrt(largest);
  verdict.weakest =
      G * (verdict.weakest_share * tolerances(size).cwiseProduct(eigen.eigenvectors().col(size - 1)));
  const std::vector<Eigen::Index> places = transferUnknowns(linear.layout, input.free_intrinsics.size());
  const std::vector<int> lens =
      linear.layout.intrinsics.front() >= 0 ? input.free_intrinsics : std::vector<int>{};
  const TransferModel model{estimate, lens, size};
  for (const double distance : {1.0, 3.0, 10.0}) {
    const auto variance =
        transferVariance(model, covariance(places, places), raysOfKind(input.kind), distance);
    if (variance) verdict.transfer.push_back({distance, std::sqrt(*variance)});
  }
  const Eigen::VectorXd jackknife = jackknifeSigmas(linear, input.captures);
  verdict.jackknife_ratio = (jackknife.array() / laser.diagonal().array().sqrt()).maxCoeff();
  const auto n =
      static_cast<double>(std::count_if(linear.layout.range_bias.begin(), linear.layout.range_bias.end(),
                                        [](int place) { return place >= 0; }));
  verdict.jackknife_wins = verdict.jackknife_ratio > kJackknifeWins * n / (n - 2.0);
  if (verdict.jackknife_wins) verdict.covariance *= std::pow(verdict.jackknife_ratio, 2);
  return verdict;
}

}  // namespace thermovox
