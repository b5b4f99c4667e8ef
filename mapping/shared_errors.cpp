#include "mapping/shared_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kEach = 64;     // readings of no more returns are taken wholly
constexpr std::size_t kStep = 32;     // of longer ones every so many-th
constexpr double kLeastCosine = 0.3;  // of ray and normal: beyond 73 degrees nothing is located
constexpr std::int32_t kReach = 2;    // cubes
constexpr double kWorld = 1 << 30;    // cubes from the origin, further than any map reaches

BlockKey cubeOf(const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d cube = (p_world / SharedMotion::kEdge).array().floor();
  return {static_cast<std::int32_t>(cube.x()), static_cast<std::int32_t>(cube.y()),
          static_cast<std::int32_t>(cube.z())};
}

double squaredDistance(const BlockKey& a, const BlockKey& b) {
  const Eigen::Vector3d apart = Eigen::Vector3d(a.x, a.y, a.z) - Eigen::Vector3d(b.x, b.y, b.z);
  return apart.squaredNorm();
}

/// The lasers' motions in the cube that holds the point, or in the nearest one (the first of equals).
std::vector<SharedMotion> motionsAt(const Eigen::Vector3d& p_world, std::span<const SharedMotion> motions) {
  const BlockKey wanted = cubeOf(p_world);
  double nearest = kReach * kReach + 0.5;
  std::vector<SharedMotion> found;
  for (const SharedMotion& motion : motions) {
    const double distance = squaredDistance(motion.cube, wanted);
    if (distance < nearest) {
      nearest = distance;
      found.clear();
    }
    if (distance == nearest && (found.empty() || found.front().cube == motion.cube)) found.push_back(motion);
  }
  return found;
}

/// How a spot moves when the surface moves against the camera: d n^T / (n d).
Eigen::Matrix3d alongTheView(const Eigen::Vector3d& view, const Eigen::Vector3d& normal) {
  if (normal.isZero() || view.norm() < 1e-3) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d d = view.normalized();
  const double cosine = normal.dot(d);
  return d * normal.transpose() / std::copysign(std::max(std::abs(cosine), kLeastCosine), cosine);
}

/// Of both together, by their counts.
SharedMotion average(const SharedMotion& a, const SharedMotion& b) {
  const float total = static_cast<float>(a.count) + static_cast<float>(b.count);
  const float of_a = static_cast<float>(a.count) / total, of_b = static_cast<float>(b.count) / total;
  return {a.cube,
          a.laser,
          a.count + b.count,
          of_a * a.by_rotation + of_b * b.by_rotation,
          of_a * a.by_translation + of_b * b.by_translation,
          of_a * a.by_range + of_b * b.by_range,
          of_a * a.lever + of_b * b.lever,
          of_a * a.view + of_b * b.view};
}

/// Of one laser's own errors.
Eigen::Matrix3d laserCovariance(const SharedMotion& motion, const Laser& laser) {
  Eigen::Matrix<double, 3, 6> A;
  A.leftCols<3>() = motion.by_rotation.cast<double>();
  A.rightCols<3>() = motion.by_translation.cast<double>();
  const Eigen::Vector3d u = motion.by_range.cast<double>() * laser.range_bias_sigma;
  return A * laser.covariance_body_laser * A.transpose() + u * u.transpose();
}

}  // namespace

void SharedMotions::add(std::span<const PlacedReturn> reading, std::size_t laser_index) {
  const Laser& laser = mission_.rig.lasers[laser_index];
  const std::size_t step = reading.size() <= kEach ? 1 : kStep;
  for (std::size_t i = 0; i < reading.size(); i += step) {
    const PlacedReturn& placed = reading[i];
    const std::variant<Pose, NoPose> at = mission_.trajectory.at(placed.stamp);
    const Pose* T_world_body = std::get_if<Pose>(&at);
    if (T_world_body == nullptr) continue;
    const Eigen::Matrix3d R_world_body = T_world_body->matrix();
    const Eigen::Vector3d p_body = T_world_body->inverse() * placed.p_world;
    Sums& sums = sums_[{cubeOf(placed.p_world), static_cast<std::uint32_t>(laser_index)}];
    ++sums.count;
    sums.by_rotation -= R_world_body * skew(p_body - laser.T_body_laser.translation);
    sums.by_translation += R_world_body;
    sums.by_range += (placed.p_world - placed.origin_world).normalized();
    sums.lever += placed.p_world - T_world_body->translation;
    if (!mission_.rig.thermal_camera) continue;
    const ThermalCamera& camera = *mission_.rig.thermal_camera;
    const Eigen::Vector3d p_camera = camera.T_body_camera.inverse() * p_body;
    if (camera.camera.project(p_camera)) {
      sums.view += R_world_body * (camera.T_body_camera.rotation * p_camera.normalized());
    }
  }
}

std::vector<SharedMotion> SharedMotions::means() const {
  std::vector<SharedMotion> motions;
  motions.reserve(sums_.size());
  for (const auto& [key, sums] : sums_) {
    const double share = 1.0 / sums.count;
    motions.push_back({std::get<0>(key), std::get<1>(key), sums.count,
                       (sums.by_rotation * share).cast<float>(), (sums.by_translation * share).cast<float>(),
                       (sums.by_range * share).cast<float>(), (sums.lever * share).cast<float>(),
                       (sums.view * share).cast<float>()});
  }
  return motions;
}

std::vector<SharedMotion> moved(std::span<const SharedMotion> motions, const Pose& T_world_map) {
  const Eigen::Matrix3f R = T_world_map.matrix().cast<float>();
  std::map<std::tuple<BlockKey, std::uint32_t>, SharedMotion> by_cube;
  for (const SharedMotion& motion : motions) {
    const Eigen::Vector3d centre =
        (Eigen::Vector3d(motion.cube.x, motion.cube.y, motion.cube.z).array() + 0.5) * SharedMotion::kEdge;
    const Eigen::Vector3d there = T_world_map * centre;
    if (!((there / SharedMotion::kEdge).cwiseAbs().maxCoeff() < kWorld))
      throw DataError("is moved out of the world, expected it nearer to the origin");
    SharedMotion turned{cubeOf(there),
                        motion.laser,
                        motion.count,
                        R * motion.by_rotation,
                        R * motion.by_translation,
                        R * motion.by_range,
                        R * motion.lever,
                        R * motion.view};
    const auto [place, is_new] = by_cube.try_emplace({turned.cube, turned.laser}, turned);
    if (!is_new) place->second = average(place->second, turned);
  }
  std::vector<SharedMotion> result;
  for (const auto& [key, motion] : by_cube) result.push_back(motion);
  return result;
}

Eigen::Matrix3d sharedCovariance(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal,
                                 std::span<const SharedMotion> motions, const Rig& rig,
                                 const PoseSigmas& pose) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  const std::vector<SharedMotion> here = motionsAt(p_world, motions);
  double total = 0.0;
  for (const SharedMotion& motion : here) total += motion.count;
  Eigen::Vector3d lever = Eigen::Vector3d::Zero(), view = Eigen::Vector3d::Zero();
  for (const SharedMotion& motion : here) {
    lever += motion.count / total * motion.lever.cast<double>();
    view += motion.count / total * motion.view.cast<double>();
  }
  const Eigen::Matrix3d to_spot = alongTheView(view, normal);
  for (const SharedMotion& motion : here) {  // the lasers' errors are independent of each other
    const double share = motion.count / total;
    const Eigen::Matrix3d of_laser = laserCovariance(motion, rig.lasers.at(motion.laser));
    covariance += share * share * to_spot * of_laser * to_spot.transpose();
  }
  if (here.empty()) return covariance;
  const Eigen::Matrix3d turned = skew(lever);
  covariance += pose.translation * pose.translation * Eigen::Matrix3d::Identity();
  covariance += pose.rotation * pose.rotation * turned * turned.transpose();
  return covariance;
}

}  // namespace thermovox
