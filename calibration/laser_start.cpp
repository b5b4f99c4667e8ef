#include "calibration/laser_start.hpp"

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "calibration/plane_residual.hpp"
#include "calibration/pose_manifold.hpp"
#include "calibration/pose_numbers.hpp"

namespace thermovox {
namespace {

constexpr double kOffPlane = 0.03;  // metres, along the ray
constexpr double kOffPlate = 0.05;  // metres, beyond an edge
constexpr double kMostOff = 3.0;    // of both, where a capture is not explained
constexpr int kSubsets = 300;       // of captures, for linear solutions
constexpr double kOther = 5.0 * std::numbers::pi / 180.0;

/// A candidate against a board: ranges off its plane, and hits off its plate, each in units of what a start
/// may be off. Block: T_reference_laser [7]. Residual: 3 a ray.
struct SightResidual {
  Pose T_reference_board;
  const PlaneMoments* candidate;
  Eigen::Vector2d half_plate;

  template <typename T>
  bool operator()(const T* const* blocks, T* residual) const {
    const T* T_reference_laser = blocks[0];
    const Eigen::Map<const Eigen::Quaternion<T>> turn(T_reference_laser);
    const Eigen::Map<const Vec3<T>> place(T_reference_laser + 4);
    const Eigen::Quaternion<T> board = T_reference_board.rotation.cast<T>();
    const Vec3<T> origin = board.conjugate() * (place - T_reference_board.translation.cast<T>());
    const T scale(1.0 / std::sqrt(static_cast<double>(candidate->corner_rays.size())));
    for (std::size_t i = 0; i < candidate->corner_rays.size(); ++i) {
      const Vec3<T> ray = board.conjugate() * (turn * candidate->corner_rays[i].cast<T>());
      const T range(candidate->corner_ranges[i]);
      const Vec3<T> hit = origin + range * ray;
      // The distance along the ray, but for grazing ones, whose plane is never reached.
      using std::abs;
      const T steep = abs(ray.z()) > T(0.3) ? abs(ray.z()) : T(0.3);
      residual[3 * i] = scale * hit.z() / (steep * T(kOffPlane));
      residual[3 * i + 1] = scale * beyond(hit.x(), half_plate.x());
      residual[3 * i + 2] = scale * beyond(hit.y(), half_plate.y());
    }
    return true;
  }

 private:
  template <typename T>
  static T beyond(const T& place, double half) {
    if (place > T(half)) return (place - T(half)) / T(kOffPlate);
    if (place < T(-half)) return (place + T(half)) / T(kOffPlate);
    return T(0);
  }
};

class Start {
 public:
  Start(const std::vector<LaserSight>& sights, LaserKind kind, const Eigen::Vector2d& plate)
      : sights_(sights), kind_(kind), half_plate_(0.5 * plate) {}

  /// What a pose leaves unexplained, and which candidates it takes for the boards.
  [[nodiscard]] LaserStart judged(const Pose& T_reference_laser) const;
  /// The best pose near this one.
  [[nodiscard]] LaserStart refined(const Pose& T_reference_laser) const;
  /// Linear solution of some captures with a candidate each.
  [[nodiscard]] std::optional<Pose> linear(
      const std::vector<std::pair<std::size_t, std::size_t>>& some) const;

 private:
  [[nodiscard]] double offBy(const LaserSight& sight, const PlaneMoments& candidate,
                             const PoseNumbers& laser) const;

  const std::vector<LaserSight>& sights_;
  LaserKind kind_;
  Eigen::Vector2d half_plate_;
};

double Start::offBy(const LaserSight& sight, const PlaneMoments& candidate, const PoseNumbers& laser) const {
  const SightResidual residual_of{sight.T_reference_board, &candidate, half_plate_};
  std::array<double, 12> residuals{};
  const double* block = laser.data();
  residual_of(&block, residuals.data());
  double squares = 0.0;
  for (std::size_t i = 0; i < 3 * candidate.corner_rays.size(); ++i) squares += residuals[i] * residuals[i];
  return squares;
}

LaserStart Start::judged(const Pose& T_reference_laser) const {
  LaserStart start{.T_reference_laser = T_reference_laser, .chosen = {}, .cost = 0.0, .rival = {}};
  const PoseNumbers laser = numbersOf(T_reference_laser);
  std::size_t seen = 0;
  for (const LaserSight& sight : sights_) {
    std::optional<std::size_t> chosen;
    double least = kMostOff * kMostOff;
    for (std::size_t i = 0; i < sight.candidates.size(); ++i) {
      const double off = offBy(sight, sight.candidates[i], laser);
      if (!(off < least)) continue;
      least = off;
      chosen = i;
    }
    start.chosen.push_back(chosen);
    if (sight.candidates.empty()) continue;
    ++seen;
    start.cost += least / (kMostOff * kMostOff);
  }
  start.cost = seen == 0 ? 1.0 : start.cost / static_cast<double>(seen);
  return start;
}

/// The candidates are chosen anew after every refinement, at first the nearest ones however far they are.
LaserStart Start::refined(const Pose& T_reference_laser) const {
  PoseNumbers laser = numbersOf(T_reference_laser);
  for (int round = 0; round < 3; ++round) {
    ceres::Problem problem;
    for (const LaserSight& sight : sights_) {
      const PlaneMoments* nearest = nullptr;
      for (const PlaneMoments& candidate : sight.candidates) {
        if (nearest == nullptr || offBy(sight, candidate, laser) < offBy(sight, *nearest, laser))
          nearest = &candidate;
      }
      if (nearest == nullptr) continue;
      auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<SightResidual, 7>>(
          new SightResidual{sight.T_reference_board, nearest, half_plate_});
      cost->AddParameterBlock(7);
      cost->SetNumResiduals(static_cast<int>(3 * nearest->corner_rays.size()));
      problem.AddResidualBlock(cost.release(), new ceres::CauchyLoss(1.0), laser.data());
    }
    if (problem.NumResidualBlocks() == 0) break;
    if (kind_ == LaserKind::beam) {
      problem.SetManifold(laser.data(), new BeamManifold);
    } else {
      problem.SetManifold(laser.data(), new LaserManifold);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 50;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
  }
  return judged(poseOf(laser));
}

/// The rotation nearest to the columns that were solved for; of fewer than three the others follow.
std::optional<Eigen::Quaterniond> rotationOf(const Eigen::MatrixXd& columns) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  R.leftCols(columns.cols()) = columns;
  if (columns.cols() == 1) return std::nullopt;  // a direction only: see linear()
  if (columns.cols() == 2) R.col(2) = R.col(0).cross(R.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  if (nearest.determinant() < 0.0)
    nearest = svd.matrixU() * Eigen::Vector3d(1, 1, -1).asDiagonal() * svd.matrixV().transpose();
  return Eigen::Quaterniond(nearest);
}

std::optional<Pose> Start::linear(const std::vector<std::pair<std::size_t, std::size_t>>& some) const {
  const int dimensions = dimensionsOf(kind_);
  const int unknowns = 3 * dimensions + 3;
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> values;
  for (const auto& [capture, candidate] : some) {
    const LaserSight& sight = sights_[capture];
    const Eigen::Vector3d normal = sight.T_reference_board.rotation * Eigen::Vector3d::UnitZ();
    const PlaneMoments& moments = sight.candidates[candidate];
    for (std::size_t i = 0; i < moments.corner_rays.size(); ++i) {
      const Eigen::Vector3d p = moments.corner_ranges[i] * moments.corner_rays[i];
      Eigen::VectorXd row(unknowns);
      for (int column = 0; column < dimensions; ++column) row.segment<3>(3 * column) = p[column] * normal;
      row.tail<3>() = normal;
      rows.push_back(row);
      values.push_back(normal.dot(sight.T_reference_board.translation));
    }
  }
  if (static_cast<int>(rows.size()) < unknowns) return std::nullopt;
  Eigen::MatrixXd A(rows.size(), unknowns);
  for (std::size_t i = 0; i < rows.size(); ++i) A.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  if (qr.rank() < unknowns) return std::nullopt;
  const Eigen::VectorXd x =
      qr.solve(Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  if (!x.allFinite() || !(x.head<3>().norm() > 0.1)) return std::nullopt;
  const Eigen::MatrixXd columns = Eigen::Map<const Eigen::MatrixXd>(x.data(), 3, dimensions);
  const Eigen::Quaterniond R = rotationOf(columns).value_or(
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), columns.col(0)));
  return Pose{R.normalized(), x.tail<3>()};
}

/// Rotations that take axes to axes.
std::vector<Eigen::Quaterniond> axisRotations() {
  std::vector<Eigen::Quaterniond> rotations;
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      if (x / 2 == y / 2) continue;
      Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
      R(x / 2, 0) = x % 2 == 0 ? 1.0 : -1.0;
      R(y / 2, 1) = y % 2 == 0 ? 1.0 : -1.0;
      R.col(2) = R.col(0).cross(R.col(1));
      rotations.emplace_back(R);
    }
  }
  return rotations;
}

/// The best of the linear solutions of random subsets.
std::optional<LaserStart> bestLinear(const Start& start, const std::vector<LaserSight>& sights,
                                     LaserKind kind) {
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (!sights[i].candidates.empty()) seen.push_back(i);
  }
  const std::size_t fewest = kind == LaserKind::beam ? 6 : kind == LaserKind::scan ? 5 : 4;
  if (seen.size() < fewest) return std::nullopt;
  std::mt19937_64 random(1);
  std::optional<LaserStart> best;
  for (int subset = 0; subset < kSubsets; ++subset) {
    // The first subset is everything, by the likeliest candidates.
    const std::size_t size = subset == 0 ? seen.size() : std::min(seen.size(), fewest + 1);
    for (std::size_t i = 0; subset > 0 && i < size; ++i)
      std::swap(seen[i], seen[i + random() % (seen.size() - i)]);
    std::vector<std::pair<std::size_t, std::size_t>> some;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t candidates = sights[seen[i]].candidates.size();
      const bool likeliest = subset == 0 || random() % 2 == 0;
      some.emplace_back(seen[i], likeliest ? 0 : random() % candidates);
    }
    const std::optional<Pose> pose = start.linear(some);
    if (!pose) continue;
    LaserStart judged = start.judged(*pose);
    if (!best || judged.cost < best->cost) best = std::move(judged);
  }
  return best;
}

/// How differently two poses point: a beam's roll does not count.
double turnApart(LaserKind kind, const Pose& a, const Pose& b) {
  if (kind != LaserKind::beam) return a.rotation.angularDistance(b.rotation);
  const double cosine = (a.rotation * Eigen::Vector3d::UnitX()).dot(b.rotation * Eigen::Vector3d::UnitX());
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

Pose withRollOf(const Pose& guess, const Pose& pose) {
  const Eigen::Vector3d from = guess.rotation * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d to = pose.rotation * Eigen::Vector3d::UnitX();
  return {(Eigen::Quaterniond::FromTwoVectors(from, to) * guess.rotation).normalized(), pose.translation};
}

std::optional<LaserStart> startLaser(const std::vector<LaserSight>& sights, LaserKind kind, const Pose& guess,
                                     const Eigen::Vector2d& plate) {
  const bool none = std::all_of(sights.begin(), sights.end(),
                                [](const LaserSight& sight) { return sight.candidates.empty(); });
  if (none) return std::nullopt;
  const Start start(sights, kind, plate);
  std::vector<LaserStart> answers{start.refined(guess)};
  if (const std::optional<LaserStart> linear = bestLinear(start, sights, kind)) {
    const Pose pose = linear->T_reference_laser;
    answers.push_back(start.refined(kind == LaserKind::beam ? withRollOf(guess, pose) : pose));
  }
  for (const Eigen::Quaterniond& rotation : axisRotations()) {
    const Pose pose{rotation, Eigen::Vector3d::Zero()};
    answers.push_back(start.refined(kind == LaserKind::beam ? withRollOf(guess, pose) : pose));
  }
  const auto best = std::min_element(answers.begin(), answers.end(),
                                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
  LaserStart result = *best;
  double least = 2.0 * result.cost + 1e-3;
  for (const LaserStart& other : answers) {
    if (turnApart(kind, other.T_reference_laser, result.T_reference_laser) < kOther) continue;
    if (!(other.cost < least)) continue;
    least = other.cost;
    result.rival = other.T_reference_laser;
  }
  return result;
}

}  // namespace thermovox
