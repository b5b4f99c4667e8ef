#include "apps/simulate/hall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

/// Of the planes across x, y and z.
constexpr double kShellCelsius[3] = {Hall::kEndWallCelsius, Hall::kSideWallCelsius, Hall::kFloorCelsius};

/// The nearest surface found so far along a ray.
struct Nearest {
  double range = std::numeric_limits<double>::infinity();
  double celsius = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  Eigen::Vector3d inverse;  ///< 1 / direction, infinite where it is 0
};

/// -unit vector of the axis along which the ray travels: the normal of a face that it meets from outside.
Eigen::Vector3d facing(const Ray& ray, int axis) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[axis] = ray.direction[axis] > 0.0 ? -1.0 : 1.0;
  return normal;
}

/// The hall's own six planes, met from inside.
void meetShell(const Ray& ray, const Eigen::Vector3d& low, const Eigen::Vector3d& high, Nearest& nearest) {
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0.0) continue;
    const double plane = ray.direction[axis] > 0.0 ? high[axis] : low[axis];
    const double range = (plane - ray.origin[axis]) * ray.inverse[axis];
    if (range < nearest.range) nearest = {range, kShellCelsius[axis], facing(ray, axis)};
  }
}

/// Slab test (Kay and Kajiya 1986). An origin inside the box sees nothing of it.
void meetBox(const Ray& ray, const Box& box, Nearest& nearest) {
  double enter = 0.0;
  double leave = nearest.range;
  int entered = -1;
  for (int axis = 0; axis < 3; ++axis) {
    double first = (box.low[axis] - ray.origin[axis]) * ray.inverse[axis];
    double second = (box.high[axis] - ray.origin[axis]) * ray.inverse[axis];
    if (first > second) std::swap(first, second);
    if (first > enter) {
      enter = first;
      entered = axis;
    }
    leave = std::min(leave, second);
    if (!(enter < leave)) return;
  }
  if (entered >= 0) nearest = {enter, box.celsius, facing(ray, entered)};
}

/// The side of the cylinder, and its top.
void meetCylinder(const Ray& ray, const Cylinder& cylinder, Nearest& nearest) {
  const Eigen::Vector2d to_axis(cylinder.x - ray.origin.x(), cylinder.y - ray.origin.y());
  const Eigen::Vector2d d = ray.direction.head<2>();
  const double outside = to_axis.squaredNorm() - cylinder.radius * cylinder.radius;
  const double along = to_axis.dot(d);
  if (outside > 0.0 && along <= 0.0) return;
  const double d2 = d.squaredNorm();
  const double discriminant = along * along - d2 * outside;
  if (outside > 0.0 && discriminant > 0.0) {
    const double range = (along - std::sqrt(discriminant)) / d2;
    if (range < nearest.range && ray.origin.z() + range * ray.direction.z() <= cylinder.top) {
      const Eigen::Vector2d n = (range * d - to_axis) / cylinder.radius;
      nearest = {range, cylinder.celsius, {n.x(), n.y(), 0.0}};
      return;
    }
  }
  if (ray.origin.z() > cylinder.top && ray.direction.z() < 0.0) {
    const double range = (cylinder.top - ray.origin.z()) * ray.inverse.z();
    const bool on_top = (range * d - to_axis).squaredNorm() <= cylinder.radius * cylinder.radius;
    if (on_top && range < nearest.range) nearest = {range, cylinder.celsius, Eigen::Vector3d::UnitZ()};
  }
}

double distanceToBox(const Eigen::Vector3d& p, const Box& box) {
  const double outside = (p - p.cwiseMax(box.low).cwiseMin(box.high)).norm();
  if (outside > 0.0) return outside;
  return std::min((p - box.low).minCoeff(), (box.high - p).minCoeff());
}

double distanceToCylinder(const Eigen::Vector3d& p, const Cylinder& cylinder) {
  const double side = std::abs(std::hypot(p.x() - cylinder.x, p.y() - cylinder.y) - cylinder.radius);
  return std::hypot(side, std::max(p.z() - cylinder.top, 0.0));
}

}  // namespace

Hall::Hall(const Eigen::Vector3d& size, std::vector<Box> boxes, std::vector<Cylinder> cylinders,
           std::vector<HotSpot> hot_spots, double warmer)
    : size_(size),
      boxes_(std::move(boxes)),
      cylinders_(std::move(cylinders)),
      hot_spots_(std::move(hot_spots)),
      warmer_(warmer) {}

Hall Hall::changed(const HallChanges& changes) const {
  Hall later = *this;
  later.warmer_ += changes.warmer;
  for (Box& box : later.boxes_) box.celsius += changes.warmer;
  for (Cylinder& cylinder : later.cylinders_) cylinder.celsius += changes.warmer;
  for (HotSpot& spot : later.hot_spots_) spot.peak += changes.warmer;
  for (const auto& [joint, rise] : changes.joint_rises) {
    if (joint >= later.hot_spots_.size()) {
      throw ConfigError("simulate: joint_rises names joint " + std::to_string(joint) +
                        ", expected less than the hall's " + std::to_string(later.hot_spots_.size()));
    }
    HotSpot& spot = later.hot_spots_[joint];
    spot.peak += rise - spot.delta;
    spot.delta = rise;
  }
  later.boxes_.insert(later.boxes_.end(), changes.boxes.begin(), changes.boxes.end());
  return later;
}

std::optional<Hit> Hall::castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d low(-size_.x() / 2, -size_.y() / 2, 0.0);
  const Eigen::Vector3d high(size_.x() / 2, size_.y() / 2, size_.z());
  const bool inside = (origin.array() > low.array()).all() && (origin.array() < high.array()).all();
  if (!inside || !direction.allFinite()) return std::nullopt;
  const Ray ray{origin, direction, direction.cwiseInverse()};
  Nearest nearest;
  meetShell(ray, low, high, nearest);
  nearest.celsius += warmer_;
  for (const Box& box : boxes_) meetBox(ray, box, nearest);
  for (const Cylinder& cylinder : cylinders_) meetCylinder(ray, cylinder, nearest);
  const double excess = hotSpotExcess(origin + nearest.range * direction);
  return Hit{nearest.range, nearest.celsius + excess, nearest.normal};
}

NearestSurface Hall::nearestSurface(const Eigen::Vector3d& p) const {
  NearestSurface nearest{0.0, std::numeric_limits<double>::infinity()};
  const auto take = [&nearest](double distance, double celsius) {
    if (distance < nearest.distance) nearest = {celsius, distance};
  };
  for (int axis = 0; axis < 3; ++axis) {
    const double low = axis == 2 ? 0.0 : -size_[axis] / 2;
    const double celsius = kShellCelsius[axis] + warmer_;
    take(std::abs(p[axis] - low), celsius);
    take(std::abs(p[axis] - (low + size_[axis])), celsius);
  }
  for (const Box& box : boxes_) take(distanceToBox(p, box), box.celsius);
  for (const Cylinder& cylinder : cylinders_) take(distanceToCylinder(p, cylinder), cylinder.celsius);
  nearest.temperature += hotSpotExcess(p);
  return nearest;
}

bool Hall::occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double margin) const {
  const double distance = (to - from).norm();
  if (!(distance > margin)) return false;
  const std::optional<Hit> hit = castRay(from, (to - from) / distance);
  return hit && hit->range < distance - margin;
}

double Hall::hotSpotExcess(const Eigen::Vector3d& p) const {
  double excess = 0.0;
  for (const HotSpot& spot : hot_spots_) {
    const double exponent = (p - spot.position).squaredNorm() / (2.0 * spot.sigma * spot.sigma);
    if (exponent < 40.0) excess += spot.delta * std::exp(-exponent);  // beyond: under 1e-15 C
  }
  return excess;
}

}  // namespace thermovox::simulate
