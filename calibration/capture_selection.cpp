#include "calibration/capture_selection.hpp"

#include <ceres/jet.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "calibration/plane_residual.hpp"
#include "calibration/pose_manifold.hpp"

namespace thermovox {
namespace {

constexpr double kUnlikely = 5e-4;
constexpr double kLeastKept = 0.6;  // of the captures, at first
constexpr std::size_t kFewest = 6;  // captures that are never judged
constexpr int kSteps = 8;           // of Gauss and Newton

using Matrix46 = Eigen::Matrix<double, 4, 6>;

/// A capture's plane against the laser at some pose: the residual in sigmas, how it changes with the laser's
/// pose (w in the laser, t), and its covariance by ranges and images, the bias of the ranges apart.
struct PlaneRow {
  Eigen::Vector4d residual;
  Matrix46 slope;
  Eigen::Matrix4d covariance;
  Eigen::Vector4d bias;  ///< what a metre of bias does to the residual
  int dimensions = 0;    ///< rows that say anything
};

PlaneRow rowOf(const CaptureSight& sight, const Pose& T_reference_laser) {
  using Jet = ceres::Jet<double, 12>;  // laser, then board
  const auto numbers = [](const Pose& pose, int first, bool in_laser) {
    Eigen::Matrix<Jet, 3, 1> w, t;
    for (int i = 0; i < 3; ++i) {
      w[i] = Jet(0.0, first + i);
      t[i] = Jet(pose.translation[i], first + 3 + i);
    }
    const Eigen::Quaternion<Jet> q = pose.rotation.cast<Jet>();
    const Eigen::Quaternion<Jet> turned = in_laser ? q * expRotationOf<Jet>(w) : expRotationOf<Jet>(w) * q;
    return std::array<Jet, 7>{turned.x(), turned.y(), turned.z(), turned.w(), t[0], t[1], t[2]};
  };
  const auto laser = numbers(T_reference_laser, 0, true), board = numbers(sight.T_reference_board, 6, false);
  const Vec3<Jet> change =
      inversePlane<Jet>(board.data(), laser.data()) - sight.plane->inverse_plane.cast<Jet>();
  PlaneRow row;
  Matrix46 by_board;
  for (int i = 0; i < 4; ++i) {
    Jet residual(sight.plane->offset[i]);
    for (int k = 0; k < 3; ++k) residual += change[k] * sight.plane->slope(i, k);
    row.residual[i] = residual.a;
    row.slope.row(i) = residual.v.head<6>();
    by_board.row(i) = residual.v.tail<6>();
    if (!sight.plane->slope.row(i).isZero(0.0)) ++row.dimensions;
  }
  row.bias = sight.plane->slope.col(3);
  row.covariance = Eigen::Matrix4d::Identity() + by_board * sight.covariance * by_board.transpose();
  return row;
}

Eigen::Matrix4d covarianceOf(const PlaneRow& row, double bias_sigma) {
  return row.covariance + bias_sigma * bias_sigma * row.bias * row.bias.transpose();
}

/// The tangent directions of the laser: of a beam without the roll, the first of them.
Eigen::Matrix<double, 6, Eigen::Dynamic> directionsOf(LaserKind kind) {
  const Eigen::Matrix<double, 6, 6> all = Eigen::Matrix<double, 6, 6>::Identity();
  return kind == LaserKind::beam ? all.rightCols(5) : all.rightCols(6);
}

/// What remains of a Gaussian's sigma when only this share about its middle is kept.
double trimmedSigma(double share) {
  if (share >= 1.0) return 1.0;
  const boost::math::normal gaussian;
  const double z = boost::math::quantile(gaussian, 0.5 + 0.5 * share);
  return std::sqrt(1.0 - 2.0 * z * boost::math::pdf(gaussian, z) / share);
}

/// How likely a residual of this covariance is. Along the bias its sigma is an estimate with `freedom`
/// degrees of freedom (Student's t); across, where a turned board shows, it is the known noise (chi-square).
/// The less likely of both counts, twice.
double probabilityOf(const PlaneRow& row, const Eigen::Matrix4d& covariance, double freedom) {
  const Eigen::LLT<Eigen::Matrix4d> llt(covariance);
  const Eigen::Vector4d white = llt.matrixL().solve(row.residual);
  const Eigen::Vector4d along = Eigen::Vector4d(llt.matrixL().solve(row.bias)).normalized();
  const double shift = along.dot(white), turn = white.squaredNorm() - shift * shift;
  const boost::math::students_t t(freedom);
  double least = 2.0 * boost::math::cdf(boost::math::complement(t, std::abs(shift)));
  if (row.dimensions > 1 && turn > 0.0) {
    const boost::math::chi_squared chi_squared(row.dimensions - 1);
    least = std::min(least, boost::math::cdf(boost::math::complement(chi_squared, turn)));
  }
  return std::min(1.0, 2.0 * least);
}

/// Generalised least squares on the planes alone.
class PlaneFit {
 public:
  PlaneFit(const std::vector<CaptureSight>& sights, LaserKind kind, const Pose& start)
      : sights_(sights), directions_(directionsOf(kind)) {
    state_.T_reference_laser = start;
    state_.range_bias_sigma = 0.005;
    for (const CaptureSight& sight : sights) state_.counts.push_back(sight.plane.has_value());
  }

  CaptureSelection& state() { return state_; }
  /// The laser's pose, the sigma of the biases, and every capture's probability, anew.
  void refit();
  /// The probabilities when what counts is all that is sound, not the best of it.
  void judgeWhole() { judge(1.0); }

 private:
  struct Normal {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    double squares = 0.0, log_determinant = 0.0;
  };
  [[nodiscard]] Normal normalEquations(const std::vector<PlaneRow>& rows, double bias_sigma) const;
  [[nodiscard]] std::vector<PlaneRow> rows() const;
  void step();
  void estimateBias();
  void judge(double share);

  const std::vector<CaptureSight>& sights_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> directions_;
  CaptureSelection state_;
};

std::vector<PlaneRow> PlaneFit::rows() const {
  std::vector<PlaneRow> rows;
  for (const CaptureSight& sight : sights_)
    rows.push_back(sight.plane ? rowOf(sight, state_.T_reference_laser) : PlaneRow{});
  return rows;
}

PlaneFit::Normal PlaneFit::normalEquations(const std::vector<PlaneRow>& rows, double bias_sigma) const {
  const Eigen::Index n = directions_.cols();
  Normal normal{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!state_.counts[i]) continue;
    const Eigen::LLT<Eigen::Matrix4d> llt(covarianceOf(rows[i], bias_sigma));
    const Eigen::MatrixXd J = llt.matrixL().solve(Eigen::MatrixXd(rows[i].slope * directions_));
    const Eigen::VectorXd r = llt.matrixL().solve(rows[i].residual);
    normal.information += J.transpose() * J;
    normal.gradient += J.transpose() * r;
    normal.squares += r.squaredNorm();
    normal.log_determinant += 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  }
  return normal;
}

void PlaneFit::step() {
  const Normal normal = normalEquations(rows(), state_.range_bias_sigma);
  const Eigen::VectorXd move =
      directions_ * Eigen::LDLT<Eigen::MatrixXd>(normal.information).solve(normal.gradient);
  if (!move.allFinite()) return;
  Pose& laser = state_.T_reference_laser;
  laser.rotation = (laser.rotation * expRotation(-move.head<3>())).normalized();
  laser.translation -= move.tail<3>();
}

/// The largest restricted likelihood; before, 5 mm within a factor of three.
void PlaneFit::estimateBias() {
  constexpr double kUsual = 0.005, kFactor = 3.0;               // metres
  constexpr double kLeast = 0.0002, kMost = 0.1, kRatio = 1.1;  // metres
  const std::vector<PlaneRow> all = rows();
  double least = std::numeric_limits<double>::infinity();
  for (double sigma = kLeast; sigma < kMost; sigma *= kRatio) {
    const Normal normal = normalEquations(all, sigma);
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(normal.information);
    const double cost = normal.squares - normal.gradient.dot(ldlt.solve(normal.gradient)) +
                        normal.log_determinant + ldlt.vectorD().array().abs().log().sum() +
                        std::pow(std::log(sigma / kUsual) / std::log(kFactor), 2);
    if (!(cost < least)) continue;
    least = cost;
    state_.range_bias_sigma = sigma;
  }
}

/// How likely each capture is: of those that count, without themselves. `share` of the sound ones counts.
void PlaneFit::judge(double share) {
  const auto counting = static_cast<double>(std::count(state_.counts.begin(), state_.counts.end(), true));
  const double bias_sigma = state_.range_bias_sigma / trimmedSigma(share);
  const std::vector<PlaneRow> all = rows();
  const Normal normal = normalEquations(all, bias_sigma);
  const Eigen::LDLT<Eigen::MatrixXd> information(normal.information);
  state_.probability.assign(sights_.size(), 1.0);
  for (std::size_t i = 0; i < sights_.size(); ++i) {
    if (!sights_[i].plane) continue;
    const Eigen::MatrixXd J = all[i].slope * directions_;
    const Eigen::Matrix4d by_laser = J * information.solve(J.transpose());
    const Eigen::Matrix4d own = covarianceOf(all[i], bias_sigma);
    const Eigen::Matrix4d expected =
        state_.counts[i] ? Eigen::Matrix4d(own - by_laser) : Eigen::Matrix4d(own + by_laser);
    state_.probability[i] = probabilityOf(all[i], expected, std::max(2.0, counting - 6.0));
  }
}

void PlaneFit::refit() {
  for (int i = 0; i < kSteps; ++i) {
    step();
    if (i % 3 == 2) estimateBias();
  }
  const auto planes = static_cast<double>(std::count_if(
      sights_.begin(), sights_.end(), [](const auto& sight) { return sight.plane.has_value(); }));
  judge(static_cast<double>(std::count(state_.counts.begin(), state_.counts.end(), true)) / planes);
}

/// The capture that fits least (of those that count) or best (of those that do not); none where there is
/// none.
std::optional<std::size_t> extreme(const std::vector<CaptureSight>& sights, const CaptureSelection& state,
                                   bool counting) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (!sights[i].plane || state.counts[i] != counting) continue;
    if (!found || (counting ? state.probability[i] < state.probability[*found]
                            : state.probability[i] > state.probability[*found]))
      found = i;
  }
  return found;
}

}  // namespace

CaptureSelection selectCaptures(const std::vector<CaptureSight>& sights, LaserKind kind, const Pose& start) {
  PlaneFit fit(sights, kind, start);
  CaptureSelection& state = fit.state();
  fit.refit();
  const auto planes = static_cast<double>(std::count(state.counts.begin(), state.counts.end(), true));
  const auto least = std::max(static_cast<std::size_t>(std::ceil(kLeastKept * planes)), kFewest);
  for (auto kept = static_cast<std::size_t>(planes); kept > least; --kept) {
    state.counts[*extreme(sights, state, true)] = false;
    fit.refit();
  }
  while (const std::optional<std::size_t> best = extreme(sights, state, false)) {
    if (state.probability[*best] < kUnlikely) break;
    state.counts[*best] = true;
    fit.refit();
  }
  if (planes <= static_cast<double>(kFewest + 1)) return state;
  // Whoever came in while the sigma was thought larger has to pass by the sigma of all.
  fit.judgeWhole();
  for (auto worst = extreme(sights, state, true); worst && state.probability[*worst] < kUnlikely;
       worst = extreme(sights, state, true)) {
    state.counts[*worst] = false;
    fit.refit();
    fit.judgeWhole();
  }
  return state;
}

}  // namespace thermovox
