#include "calibration/next_capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace thermovox {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTilt = 45.0 * kDegree;

/// A way to hold the board, and its words: which side is nearer to the camera.
struct Holding {
  double about_x, about_y;  ///< -1, 0 or 1 tilts
  const char* words;
};
constexpr std::array<Holding, 9> kHoldings{{{0, 0, "facing the camera"},
                                            {0, 1, "with its right side nearer"},
                                            {0, -1, "with its left side nearer"},
                                            {1, 0, "with its upper side nearer"},
                                            {-1, 0, "with its lower side nearer"},
                                            {1, 1, "with its upper right corner nearer"},
                                            {1, -1, "with its upper left corner nearer"},
                                            {-1, 1, "with its lower right corner nearer"},
                                            {-1, -1, "with its lower left corner nearer"}}};

/// Where boards stood: the mean direction from the camera, and distances to try.
struct Stand {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  std::array<double, 3> distances{};  ///< metres
};

Stand standOf(const BundleData& data, const RigEstimate& estimate) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::vector<double> distances;
  for (std::size_t i = 0; i < data.captures.size(); ++i) {
    if (!data.captures[i].plane) continue;
    sum += estimate.T_reference_board[i].translation.normalized();
    distances.push_back(estimate.T_reference_board[i].translation.norm());
  }
  const auto [nearest, farthest] = std::minmax_element(distances.begin(), distances.end());
  // As far as the squares are still found: six pixels.
  const double square = (data.points[1] - data.points[0]).norm();
  const double reach = estimate.cameras.front().parameters[kFx] * square / 6.0;
  return {sum.normalized(),
          {*nearest, std::sqrt(*nearest * *farthest), std::clamp(reach, *farthest, 1.5 * *farthest)}};
}

/// Rays of the laser as they met a board of the captures, and the sigma of a range: one stands for all.
struct TypicalRays {
  std::vector<Eigen::Vector3d> rays;
  double sigma = 0.01;
};

TypicalRays typicalRays(const BundleData& data, const RigEstimate& estimate, const Pose& board) {
  TypicalRays typical;
  const Eigen::Vector3d middle = (estimate.T_reference_laser.inverse() * board.translation).normalized();
  for (const CaptureObservations& capture : data.captures) {
    if (!capture.plane) continue;
    typical.sigma = capture.plane->sigma / std::sqrt(std::max(1, capture.plane->returns));
    Eigen::Vector3d own = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& ray : capture.plane->corner_rays) own += ray;
    const Eigen::Quaterniond turn = data.laser == LaserKind::cloud
                                        ? Eigen::Quaterniond::FromTwoVectors(own, middle)
                                        : Eigen::Quaterniond::Identity();
    for (const Eigen::Vector3d& ray : capture.plane->corner_rays) typical.rays.push_back(turn * ray);
    break;
  }
  return typical;
}

/// How much a capture would tell of a move of the laser: sum of squares in sigmas, less what its bias
/// explains.
double tells(const Pose& board, const TypicalRays& typical, const Pose& laser, const Vector6d& move,
             double range_bias_sigma) {
  const Eigen::Vector3d normal = board.rotation * Eigen::Vector3d::UnitZ();
  const auto ranges = [&](const Pose& pose) {
    Eigen::VectorXd values(typical.rays.size());
    for (std::size_t i = 0; i < typical.rays.size(); ++i) {
      values[static_cast<Eigen::Index>(i)] =
          normal.dot(board.translation - pose.translation) / normal.dot(pose.rotation * typical.rays[i]);
    }
    return values;
  };
  const Pose moved{expRotation(move.head<3>()) * laser.rotation, laser.translation + move.tail<3>()};
  const Eigen::VectorXd change = (ranges(moved) - ranges(laser)) / typical.sigma;
  const double bias = range_bias_sigma / typical.sigma;
  const auto n = static_cast<double>(change.size());
  return change.squaredNorm() - bias * bias / (1.0 + bias * bias * n) * std::pow(change.sum(), 2);
}

}  // namespace

std::string adviseCapture(const Vector6d& weakest, const BundleData& data, const RigEstimate& estimate,
                          double range_bias_sigma) {
  const bool any = std::any_of(data.captures.begin(), data.captures.end(),
                               [](const CaptureObservations& capture) { return capture.plane.has_value(); });
  if (!any) return "add captures";
  const Stand stand = standOf(data, estimate);
  const Vector6d move = 0.01 * weakest / weakest.norm();  // small enough to be linear
  double most = -1.0;
  std::string advice;
  for (const Holding& holding : kHoldings) {
    for (const double distance : stand.distances) {
      const Eigen::Vector3d turn(holding.about_x, holding.about_y, 0.0);
      const Pose board{expRotation(turn.norm() > 0.0 ? Eigen::Vector3d(kTilt * turn.normalized()) : turn),
                       distance * stand.direction};
      const double told = tells(board, typicalRays(data, estimate, board), estimate.T_reference_laser, move,
                                range_bias_sigma);
      if (!(told > most * 1.05)) continue;  // the simplest of about equal ones
      most = told;
      advice = fmt::format("add captures of the board {}{} at about {:.1f} m",
                           turn.norm() > 0.0 ? "tilted by 45 degrees " : "", holding.words, distance);
    }
  }
  return advice;
}

}  // namespace thermovox
