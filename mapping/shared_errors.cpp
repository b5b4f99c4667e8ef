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
constexpr double kViewSigma = 0.05;  // radians: what a body moves while it passes, a fifth of a metre at four

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

/// What the direction of the view is wrong by: a spot was not seen from just where the rest of its cube was.
/// On the surface, across the view, in proportion to what the spot moves along it.
Eigen::Matrix3d offTheView(const Eigen::Matrix3d& along, const Eigen::Vector3d& view,
                           const Eigen::Vector3d& normal) {
  if (normal.isZero() || view.norm() < 1e-3) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d on_surface = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  return kViewSigma * kViewSigma * along.trace() * on_surface;
}

/// The motion of a place `off` the one that it is of; lever and view lead there.
SharedMotion carried(SharedMotion motion, const Eigen::Vector3f& off) {
  motion.by_rotation -= skew(off.cast<double>()).cast<float>() * motion.by_translation;
  motion.lever += off;
  if (!motion.view.isZero()) motion.view += off;
  return motion;
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
          a.view.isZero()   ? b.view
          : b.view.isZero() ? a.view
                            : Eigen::Vector3f(of_a * a.view + of_b * b.view)};
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
  const std::size_t step = reading.size() <= kEach ? 1 : kStep;
  for (std::size_t i = 0; i < reading.size(); i += step) {
    const PlacedReturn& placed = reading[i];
    const std::variant<Pose, NoPose> at = mission_.trajectory.at(placed.stamp);
    const Pose* T_world_body = std::get_if<Pose>(&at);
    if (T_world_body == nullptr) continue;
    const Eigen::Matrix3d R_world_body = T_world_body->matrix();
    const BlockKey cube = cubeOf(placed.p_world);
    const Eigen::Vector3d centre = SharedMotion{.cube = cube}.centre();
    Sums& sums = sums_[{cube, static_cast<std::uint32_t>(laser_index)}];
    ++sums.count;
    sums.by_rotation -= skew(centre - placed.origin_world) * R_world_body;
    sums.by_translation += R_world_body;
    sums.by_range += (placed.p_world - placed.origin_world).normalized();
    sums.lever += centre - T_world_body->translation;
    if (!mission_.rig.thermal_camera) continue;
    const ThermalCamera& camera = *mission_.rig.thermal_camera;
    const Pose T_world_camera = *T_world_body * camera.T_body_camera;
    if (camera.camera.project(T_world_camera.inverse() * placed.p_world)) {
      ++sums.in_view;
      sums.view += centre - T_world_camera.translation;
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
                       (sums.view / std::max(sums.in_view, 1U)).cast<float>()});
  }
  return motions;
}

std::vector<SharedMotion> moved(std::span<const SharedMotion> motions, const Pose& T_world_map) {
  const Eigen::Matrix3f R = T_world_map.matrix().cast<float>();
  std::map<std::tuple<BlockKey, std::uint32_t>, SharedMotion> by_cube;
  for (const SharedMotion& motion : motions) {
    const Eigen::Vector3d centre = T_world_map * motion.centre();
    if (!((centre / SharedMotion::kEdge).cwiseAbs().maxCoeff() < kWorld))
      throw DataError("is moved out of the world, expected it nearer to the origin");
    SharedMotion turned{cubeOf(centre),
                        motion.laser,
                        motion.count,
                        R * motion.by_rotation,
                        R * motion.by_translation,
                        R * motion.by_range,
                        R * motion.lever,
                        R * motion.view};
    turned = carried(turned, (turned.centre() - centre).cast<float>());
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
  std::vector<SharedMotion> here = motionsAt(p_world, motions);
  if (here.empty()) return pose.translation * pose.translation * Eigen::Matrix3d::Identity();
  double total = 0.0;
  for (SharedMotion& motion : here) {
    motion = carried(motion, (p_world - motion.centre()).cast<float>());
    total += motion.count;
  }
  SharedMotion all = here.front();
  for (std::size_t i = 1; i < here.size(); ++i) all = average(all, here[i]);
  const Eigen::Vector3d lever = all.lever.cast<double>();
  const Eigen::Vector3d view = all.view.cast<double>();
  const Eigen::Matrix3d to_spot = alongTheView(view, normal);
  for (const SharedMotion& motion : here) {  // the lasers' errors are independent of each other
    const double share = motion.count / total;
    const Eigen::Matrix3d of_laser = laserCovariance(motion, rig.lasers.at(motion.laser));
    covariance += share * share * to_spot * of_laser * to_spot.transpose();
  }
  covariance += offTheView(covariance, view, normal);
  const Eigen::Matrix3d turned = skew(lever);
  covariance += pose.translation * pose.translation * Eigen::Matrix3d::Identity();
  covariance += pose.rotation * pose.rotation * turned * turned.transpose();
  return covariance;
}

}  // namespace thermovox
