#include "calibration/verdict_words.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "calibration/next_capture.hpp"
#include "calibration/plane_residual.hpp"
#include "projection/kind_names.hpp"

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
  double distance_spread = 0.0;                     // standard deviation over mean
};

BoardGeometry geometryOf(const BundleData& data, const RigEstimate& estimate) {
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> distances;
  for (std::size_t i = 0; i < data.captures.size(); ++i) {
    if (!data.captures[i].plane) continue;
    normals.emplace_back(estimate.T_reference_board[i].rotation * Eigen::Vector3d::UnitZ());
    distances.push_back(estimate.T_reference_board[i].translation.norm());
  }
  if (normals.empty()) return {};
  const auto n = static_cast<double>(normals.size());
  const Eigen::Vector3d mean =
      std::accumulate(normals.begin(), normals.end(), Eigen::Vector3d::Zero().eval()).normalized();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& normal : normals) {
    const Eigen::Vector3d across = normal - mean * mean.dot(normal);
    scatter += across * across.transpose() / n;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  BoardGeometry geometry;
  geometry.larger_tilt = std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
  geometry.smaller_tilt = std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
  geometry.axis = mean.cross(eigen.eigenvectors().col(2));
  const auto [nearest, farthest] = std::minmax_element(distances.begin(), distances.end());
  geometry.nearest = *nearest;
  geometry.farthest = *farthest;
  const Eigen::Map<const Eigen::ArrayXd> all(distances.data(), static_cast<Eigen::Index>(distances.size()));
  geometry.distance_spread = std::sqrt((all - all.mean()).square().mean()) / all.mean();
  return geometry;
}

const char* axisName(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return kAxes[static_cast<std::size_t>(largest)];
}

/// The largest part of a direction (rotation, translation in the reference camera).
std::string axisWords(const Vector6d& weakest) {
  Vector6d shares = weakest;
  shares.head<3>() /= kTurn;
  shares.tail<3>() /= kShift;
  Eigen::Index largest = 0;
  shares.cwiseAbs().maxCoeff(&largest);
  return fmt::format("{} the camera's {} axis", largest < 3 ? "rotation about" : "translation along",
                     kAxes[static_cast<std::size_t>(largest % 3)]);
}

std::string directionWords(const Vector6d& weakest) {
  return fmt::format("{}: {:.2g} deg and {:.2g} mm together, one sigma", axisWords(weakest),
                     weakest.head<3>().norm() / kDegree, 1e3 * weakest.tail<3>().norm());
}

}  // namespace

std::optional<std::string> tooFewCaptures(const BundleData& data) {
  const std::size_t fewest = data.laser == LaserKind::beam ? 6 : data.laser == LaserKind::scan ? 4 : 3;
  const std::size_t planes = planesIn(data);
  if (planes >= fewest) return std::nullopt;
  return fmt::format("{} captures have the board in the images and in the laser's data, expected {} or more",
                     planes, fewest);
}

std::string undeterminedWords(const std::string& direction, const BundleData& data,
                              const RigEstimate& estimate) {
  std::string words = direction + " is not determined by " + std::to_string(planesIn(data)) + " captures";
  const std::vector<std::string> geometry = geometryWords(data, estimate);
  for (const std::string& why : geometry) words += "; " + why;
  if (geometry.empty())
    words += "; add captures, the board tilted by 30 to 60 degrees in all directions, near and far";
  return words;
}

std::string rivalWords(const LaserStart& start, const BundleData& data, const RigEstimate& estimate) {
  const double apart = start.T_reference_laser.rotation.angularDistance(start.rival->rotation) / kDegree;
  return undeterminedWords(
      fmt::format(
          "another pose of the laser, {:.0f} degrees away, explains the captures nearly as well: which",
          apart),
      data, estimate);
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

std::vector<std::string> geometryWords(const BundleData& data, const RigEstimate& estimate) {
  constexpr double kSmallTilt =
      12.0 * kDegree;                   // rms about each axis; tilts to 45 degrees all around have 22
  constexpr double kOneAxis = 0.35;     // of the larger one
  constexpr double kOneDistance = 0.1;  // of the mean; 0.5 to 1.2 m has 0.24
  const BoardGeometry geometry = geometryOf(data, estimate);
  std::vector<std::string> words;
  if (geometry.larger_tilt < kSmallTilt) {
    words.push_back(fmt::format(
        "all boards face about the same way, their tilts are {:.0f} degrees rms: tilt them by 30 to "
        "60 degrees left, right, up and down",
        geometry.larger_tilt / kDegree));
  } else if (geometry.smaller_tilt < std::min(kSmallTilt, kOneAxis * geometry.larger_tilt)) {
    words.push_back(
        fmt::format("all boards are tilted about one axis, the camera's {}: tilt them about the "
                    "axis across it as well",
                    axisName(geometry.axis)));
  }
  if (geometry.distance_spread < kOneDistance) {
    words.push_back(
        fmt::format("all boards stand at about one distance, {:.2f} to {:.2f} m: add captures "
                    "nearer and farther, the farthest three times as far as the nearest",
                    geometry.nearest, geometry.farthest));
  }
  return words;
}

void describe(LaserVerdict& verdict, const BundleData& data, const RigEstimate& estimate,
              double range_bias_sigma) {
  if (verdict.weakest_share > kUnknown) {
    verdict.observable = false;
    verdict.weakest_direction = axisWords(verdict.weakest);
    verdict.reason = undeterminedWords(verdict.weakest_direction, data, estimate);
    return;
  }
  const std::string direction = directionWords(verdict.weakest);
  const std::string advice = adviseCapture(verdict.weakest, data, estimate, range_bias_sigma);
  verdict.weakest_direction = direction + "; to know it better " + advice;
  verdict.warnings = geometryWords(data, estimate);
  const std::size_t planes = planesIn(data);
  const std::size_t asked = data.laser == LaserKind::beam ? 40 : data.laser == LaserKind::scan ? 20 : 12;
  const std::size_t least = data.laser == LaserKind::beam ? 10 : 6;
  if (planes < least || (planes < asked && verdict.weakest_share > 1.0))
    verdict.warnings.push_back(fmt::format("{} captures count, {} or more are advised for a laser of kind {}",
                                           planes, asked, nameOf(data.laser)));
  if (verdict.weakest_share > 1.0)
    verdict.warnings.push_back("not yet known to 0.2 deg and 5 mm: " + verdict.weakest_direction);
  if (verdict.jackknife_wins)
    verdict.warnings.push_back(
        fmt::format("leaving captures out one at a time scatters {:.1f} times as far as the covariance says: "
                    "something errs that is not modelled; the covariance is made as large",
                    verdict.jackknife_ratio));
}

}  // namespace thermovox
