#include "calibration/verdict_words.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "calibration/plane_residual.hpp"

namespace thermovox {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTurn = 0.2 * kDegree, kShift = 0.005;  // the tolerances
constexpr double kUnknown = 50.0;                        // tolerances: 10 degrees, 25 cm
constexpr std::array<const char*, 3> kAxes{"x (right)", "y (down)", "z (forward)"};

std::size_t planesIn(const BundleData& data) {
  return static_cast<std::size_t>(
      std::count_if(data.captures.begin(), data.captures.end(),
                    [](const auto& capture) { return capture.plane.has_value(); }));
}

/// How the boards that count were held: the spread of their normals in two directions, and their distances.
struct BoardGeometry {
  double larger_tilt = 0.0, smaller_tilt = 0.0;     // radians rms, along the main axes of the tilts
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // reference camera: what the larger tilt turns about
  double nearest = 0.0, farthest = 0.0;             // metres
};

BoardGeometry geometryOf(const BundleData& data, const RigEstimate& estimate) {
  BoardGeometry geometry{.nearest = 1e9};
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t i = 0; i < data.captures.size(); ++i) {
    if (!data.captures[i].plane) continue;
    normals.emplace_back(estimate.T_reference_board[i].rotation * Eigen::Vector3d::UnitZ());
    mean += normals.back();
    const double distance = estimate.T_reference_board[i].translation.norm();
    geometry.nearest = std::min(geometry.nearest, distance);
    geometry.farthest = std::max(geometry.farthest, distance);
  }
  mean.normalize();
  for (const Eigen::Vector3d& normal : normals) {
    const Eigen::Vector3d across = normal - mean * mean.dot(normal);
    scatter += across * across.transpose() / static_cast<double>(normals.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  geometry.larger_tilt = std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
  geometry.smaller_tilt = std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
  geometry.axis = mean.cross(eigen.eigenvectors().col(2));
  return geometry;
}

const char* axisName(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return kAxes[static_cast<std::size_t>(largest)];
}

}  // namespace

std::optional<std::string> tooFewCaptures(const BundleData& data) {
  const std::size_t fewest = data.laser == LaserKind::beam ? 6 : data.laser == LaserKind::scan ? 4 : 3;
  const std::size_t planes = planesIn(data);
  if (planes >= fewest) return std::nullopt;
  return fmt::format("{} captures have the board in the images and in the laser's data, expected {} or more",
                     planes, fewest);
}

std::string rivalWords(const LaserStart& start) {
  const double apart = start.T_reference_laser.rotation.angularDistance(start.rival->rotation) / kDegree;
  return fmt::format(
      "another pose of the laser, {:.0f} degrees away, explains the captures nearly as well: add captures "
      "with the board tilted in other directions and at other distances",
      apart);
}

std::string movedWords(const PlaneMoments& plane, const RigEstimate& estimate, std::size_t capture,
                       double probability) {
  const Pose& board = estimate.T_reference_board[capture];
  const Pose& laser = estimate.T_reference_laser;
  const Eigen::Vector3d normal = board.rotation * Eigen::Vector3d::UnitZ();
  double most = 0.0;
  for (std::size_t i = 0; i < plane.corner_rays.size(); ++i) {
    const Eigen::Vector3d p = laser * (plane.corner_ranges[i] * plane.corner_rays[i]);
    const double off = normal.dot(p - board.translation);
    if (std::abs(off) > std::abs(most)) most = off;
  }
  return fmt::format(
      "the board moved between the image and the laser: its returns are up to {:.0f} mm off the plane of the "
      "image's board (chance {:.0e})",
      1e3 * std::abs(most), probability);
}

std::vector<std::string> geometryWords(const BundleData& data, const RigEstimate& estimate, bool refused) {
  constexpr double kSmallTilt = 6.0 * kDegree;
  constexpr double kFewDistances = 1.2;  // farthest over nearest
  const BoardGeometry geometry = geometryOf(data, estimate);
  std::vector<std::string> words;
  if (geometry.larger_tilt < kSmallTilt) {
    words.push_back(
        fmt::format("all boards face the same way, within {:.0f} degrees: tilt them by 30 to 60 "
                    "degrees left, right, up and down",
                    2.0 * geometry.larger_tilt / kDegree));
  } else if (geometry.smaller_tilt < std::min(kSmallTilt, 0.25 * geometry.larger_tilt)) {
    words.push_back(
        fmt::format("all boards are tilted about one axis, the camera's {}: tilt them about the "
                    "axis across it as well",
                    axisName(geometry.axis)));
  }
  if (geometry.farthest < kFewDistances * geometry.nearest) {
    words.push_back(
        fmt::format("all boards stand at about one distance, {:.2f} to {:.2f} m: add captures "
                    "nearer and farther, the farthest three times as far as the nearest",
                    geometry.nearest, geometry.farthest));
  }
  if (words.empty() && refused) {
    words.push_back(
        "the captures do not determine the laser's pose: tilt the board by 30 to 60 degrees in all "
        "directions, at near and far distances");
  }
  return words;
}

void describe(LaserVerdict& verdict, const BundleData& data, const RigEstimate& estimate) {
  Vector6d shares = verdict.weakest;
  shares.head<3>() /= kTurn;
  shares.tail<3>() /= kShift;
  Eigen::Index largest = 0;
  shares.cwiseAbs().maxCoeff(&largest);
  const double turn = verdict.weakest.head<3>().norm() / kDegree,
               shift = 1e3 * verdict.weakest.tail<3>().norm();
  verdict.weakest_direction =
      fmt::format("{} the camera's {} axis: {:.2g} deg and {:.2g} mm together, one sigma",
                  largest < 3 ? "rotation about" : "translation along",
                  kAxes[static_cast<std::size_t>(largest % 3)], turn, shift);
  const std::vector<std::string> geometry = geometryWords(data, estimate, verdict.weakest_share > kUnknown);
  if (verdict.weakest_share > kUnknown) {
    verdict.observable = false;
    verdict.reason = verdict.weakest_direction + ": " + geometry.front();
    return;
  }
  verdict.warnings.insert(verdict.warnings.end(), geometry.begin(), geometry.end());
  const std::size_t planes = planesIn(data);
  const std::size_t asked = data.laser == LaserKind::beam ? 40 : data.laser == LaserKind::scan ? 20 : 12;
  if (planes < asked && verdict.weakest_share > 1.0)
    verdict.warnings.push_back(
        fmt::format("{} captures count, {} or more are advised for this kind of laser", planes, asked));
  if (verdict.weakest_share > 1.0)
    verdict.warnings.push_back("not yet known to 0.2 deg and 5 mm: " + verdict.weakest_direction);
  if (verdict.jackknife_ratio > 2.0)
    verdict.warnings.push_back(
        fmt::format("leaving captures out one at a time scatters {:.1f} times as far as the covariance says: "
                    "something that "
                    "is not modelled errs; the covariance is made as large",
                    verdict.jackknife_ratio));
}

}  // namespace thermovox
