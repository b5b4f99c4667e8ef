#include "tests/benchmark/cramer_rao.hpp"

#include <Eigen/Dense>
#include <functional>

namespace thermovox::bench {
namespace {

constexpr int kLens = 8;  // fx fy cx cy k1 k2 p1 p2
constexpr int kBoard = 6;
constexpr double kEdgeBiasSigma = 0.010;  // metres: the estimator's prior

Pose moved(const Pose& pose, const Eigen::VectorXd& x) {
  return {expRotation(x.head<3>()) * pose.rotation, pose.translation + x.segment<3>(3)};
}

/// Unknowns that all captures share: the laser (6), a lens a camera, the other camera's pose, the edges'
/// bias.
int sharedOf(const MeasuredSetUp& set_up) {
  const int cameras = static_cast<int>(set_up.cameras.size());
  return 6 + kLens * cameras + 6 * (cameras - 1) + 1;
}

/// All that a capture measures, each in its own sigmas (edges whitened), at unknowns `shared` and `own`: the
/// board's pose, then the bias of the ranges; both as differences from the truth.
class Instruments {
 public:
  Instruments(const MeasuredSetUp& set_up, const MeasuredCapture& capture, const Eigen::VectorXd& x)
      : set_up_(set_up), capture_(capture), x_(x), own_(sharedOf(set_up)) {}

  [[nodiscard]] Eigen::VectorXd measure() const {
    std::vector<double> values;
    for (std::size_t camera = 0; camera < set_up_.cameras.size(); ++camera) addCorners(values, camera);
    const Pose T_board_laser = moved(capture_.T_reference_board, x_.segment<6>(own_)).inverse() *
                               moved(set_up_.T_reference_laser, x_.head<6>());
    for (const Eigen::Vector3d& ray : capture_.rays) {
      const double range = -T_board_laser.translation.z() / (T_board_laser.rotation * ray).z();
      values.push_back((range + x_[own_ + kBoard]) / set_up_.range_sigma);
    }
    for (const EdgeSide& side : capture_.edges) addEdge(values, side, T_board_laser);
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

 private:
  void addCorners(std::vector<double>& values, std::size_t camera) const {
    Intrinsics lens = set_up_.cameras[camera];
    const int place = 6 + kLens * static_cast<int>(camera);
    for (int i = 0; i < kLens; ++i) lens.parameters[static_cast<std::size_t>(i)] += x_[place + i];
    Pose T_camera_reference = set_up_.T_camera_reference[camera];
    if (camera > 0) {
      const int pose = 6 + kLens * static_cast<int>(set_up_.cameras.size());
      T_camera_reference = moved(T_camera_reference, x_.segment<6>(pose));
    }
    const Pose T_camera_board = T_camera_reference * moved(capture_.T_reference_board, x_.segment<6>(own_));
    for (const Eigen::Vector3d& point : set_up_.points) {
      const Eigen::Vector2d pixel =
          pixelFromCamera<double>(lens.model, lens.parameters.data(), T_camera_board * point);
      for (int i = 0; i < 2; ++i) values.push_back(pixel[i] / set_up_.corner_sigma_px[camera]);
    }
  }

  void addEdge(std::vector<double>& values, const EdgeSide& side, const Pose& T_board_laser) const {
    const auto count = static_cast<Eigen::Index>(side.crossings.size());
    Eigen::VectorXd across(count);
    Eigen::MatrixXd covariance =
        Eigen::MatrixXd::Constant(count, count, side.offset_sigma * side.offset_sigma);
    for (Eigen::Index i = 0; i < count; ++i) {
      const EdgeCrossing& crossing = side.crossings[static_cast<std::size_t>(i)];
      const Eigen::Vector3d ray = T_board_laser.rotation * crossing.ray;
      const Eigen::Vector3d& origin = T_board_laser.translation;
      const double outwards = crossing.place > 0.0 ? 1.0 : -1.0;
      across[i] =
          outwards * (origin[crossing.axis] - origin.z() / ray.z() * ray[crossing.axis]) - x_[own_ - 1];
      covariance(i, i) += crossing.sigma * crossing.sigma;
    }
    const Eigen::VectorXd white = Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL().solve(across);
    values.insert(values.end(), white.data(), white.data() + count);
  }

  const MeasuredSetUp& set_up_;
  const MeasuredCapture& capture_;
  const Eigen::VectorXd& x_;
  int own_;
};

Eigen::MatrixXd jacobianOf(const MeasuredSetUp& set_up, const MeasuredCapture& capture, int unknowns) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd J;
  for (int i = 0; i < unknowns; ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(unknowns, i);
    const Eigen::VectorXd behind = -step;
    const Eigen::VectorXd slope =
        (Instruments(set_up, capture, step).measure() - Instruments(set_up, capture, behind).measure()) /
        (2.0 * kStep);
    if (J.size() == 0) J.resize(slope.size(), unknowns);
    J.col(i) = slope;
  }
  return J;
}

}  // namespace

Matrix6d cramerRaoBound(const MeasuredSetUp& set_up) {
  const int shared = sharedOf(set_up);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(shared, shared);
  information(shared - 1, shared - 1) = 1.0 / (kEdgeBiasSigma * kEdgeBiasSigma);
  for (const MeasuredCapture& capture : set_up.captures) {
    const int unknowns = shared + kBoard + 1;
    const Eigen::MatrixXd J = jacobianOf(set_up, capture, unknowns);
    Eigen::MatrixXd fisher = J.transpose() * J;
    const double known = set_up.range_bias_sigma > 0.0 ? set_up.range_bias_sigma : 1e-6;
    fisher(unknowns - 1, unknowns - 1) += 1.0 / (known * known);
    const Eigen::MatrixXd across = fisher.bottomLeftCorner(kBoard + 1, shared);
    information +=
        fisher.topLeftCorner(shared, shared) -
        across.transpose() *
            Eigen::LDLT<Eigen::MatrixXd>(fisher.bottomRightCorner(kBoard + 1, kBoard + 1)).solve(across);
  }
  const Eigen::MatrixXd rest = information.bottomRightCorner(shared - 6, shared - 6);
  const Eigen::MatrixXd across = information.bottomLeftCorner(shared - 6, 6);
  const Matrix6d laser = information.topLeftCorner<6, 6>() -
                         across.transpose() * Eigen::LDLT<Eigen::MatrixXd>(rest).solve(across);
  // A beam's roll: nothing is known of the turn about its axis.
  Eigen::MatrixXd span = Eigen::MatrixXd::Identity(6, 6);
  if (set_up.laser == LaserKind::beam) {
    const Eigen::Matrix3d R = set_up.T_reference_laser.matrix();
    span = Eigen::MatrixXd::Zero(6, 5);
    span.topLeftCorner<3, 2>() = R.rightCols<2>();
    span.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity();
  }
  return span * (span.transpose() * laser * span).inverse() * span.transpose();
}

}  // namespace thermovox::bench
