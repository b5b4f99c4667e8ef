#include "tests/benchmark/hall_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace thermovox::bench {
namespace {

using Hit = HallScene::Hit;

constexpr double kRackLength = 48.0, kRackHalfDepth = 0.6;  // metres
constexpr double kLevelHeight = 1.55, kShelfThickness = 0.1;
constexpr int kLevels = 4, kSlots = 40;  // of a row of racks, and of a level
constexpr int kPosts = 9;                // of a row of racks

/// Where a ray enters a box; nullopt when it does not from outside.
std::optional<Hit> meet(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double in = 0.0, out = std::numeric_limits<double>::max();
  int face = -1;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.low[i] - origin[i]) / direction[i], b = (box.high[i] - origin[i]) / direction[i];
    if (std::min(a, b) > in) {
      in = std::min(a, b);
      face = i;
    }
    out = std::min(out, std::max(a, b));
  }
  if (face < 0 || in >= out) return std::nullopt;
  Hit hit{.range = in, .celsius = box.celsius};
  hit.normal[face] = direction[face] > 0.0 ? -1.0 : 1.0;
  return hit;
}

/// The same for the side and the top of a cylinder.
std::optional<Hit> meet(const Cylinder& cylinder, const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& direction) {
  const Eigen::Vector2d from = origin.head<2>() - cylinder.centre, along = direction.head<2>();
  const double a = along.squaredNorm(), b = from.dot(along);
  const double discriminant = b * b - a * (from.squaredNorm() - cylinder.radius * cylinder.radius);
  if (a > 0.0 && discriminant > 0.0) {
    const double range = (-b - std::sqrt(discriminant)) / a;
    if (range > 0.0 && origin.z() + range * direction.z() <= cylinder.top) {
      Hit hit{.range = range, .celsius = cylinder.celsius};
      hit.normal.head<2>() = (from + range * along) / cylinder.radius;
      return hit;
    }
  }
  const double range = (cylinder.top - origin.z()) / direction.z();
  if (!(direction.z() < 0.0) || range <= 0.0) return std::nullopt;
  if ((from + range * along).norm() > cylinder.radius) return std::nullopt;
  return Hit{.range = range, .normal = {0.0, 0.0, 1.0}, .celsius = cylinder.celsius};
}

/// Where a ray leaves the hall.
Hit meetHall(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d low(-HallScene::kSize.x() / 2, -HallScene::kSize.y() / 2, 0.0);
  Hit hit{.range = std::numeric_limits<double>::max()};
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0.0) continue;
    const double wall = low[i] + (direction[i] > 0.0 ? HallScene::kSize[i] : 0.0);
    const double range = (wall - origin[i]) / direction[i];
    if (range >= hit.range) continue;
    hit = {.range = range, .celsius = i == 2 ? 20.0F : 21.0F};
    hit.normal[i] = direction[i] > 0.0 ? -1.0 : 1.0;
  }
  return hit;
}

}  // namespace

HallScene::HallScene(std::uint64_t seed) : bins_(std::size_t{kNx} * kNy * kNz) {
  addRacks(seed);
  addCylinders();
  fillBins();
}

void HallScene::addRacks(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
  };
  std::vector<Box> goods;
  for (const double y : kRackRows) {
    const double from = -kRackLength / 2;
    for (int post = 0; post < kPosts; ++post) {
      const double x = from + post * kRackLength / (kPosts - 1);
      boxes_.push_back(
          {{x - 0.06, y - kRackHalfDepth, 0.0}, {x + 0.06, y + kRackHalfDepth, kLevels * kLevelHeight}});
    }
    for (int level = 0; level < kLevels; ++level) {
      const double z = 0.15 + level * kLevelHeight;
      boxes_.push_back({{from, y - kRackHalfDepth, z - kShelfThickness}, {-from, y + kRackHalfDepth, z}});
      for (int slot = 0; slot < kSlots; ++slot) {
        const double x = from + (slot + 0.5) * kRackLength / kSlots;
        const double half = uniform(0.3, 0.52), depth = uniform(0.35, 0.58);
        goods.push_back({{x - half, y - depth, z},
                         {x + half, y + depth, z + uniform(0.4, 1.2)},
                         static_cast<float>(random() % 16 == 0 ? uniform(35.0, 80.0) : uniform(18.0, 26.0))});
      }
    }
  }
  std::shuffle(goods.begin(), goods.end(), random);
  goods.resize(kBoxes - boxes_.size());
  boxes_.insert(boxes_.end(), goods.begin(), goods.end());
}

void HallScene::addCylinders() {
  for (std::size_t i = 0; i < kCylinders; ++i) {
    const double x = -26.25 + 7.5 * static_cast<double>(i / 2), y = i % 2 == 0 ? -13.6 : 13.6;
    const bool column = i % 4 < 2;
    cylinders_.push_back(
        {{x, y}, column ? 0.3 : 0.9, column ? kSize.z() : 2.6, static_cast<float>(20 + 5 * (i % 5))});
  }
}

void HallScene::fillBins() {
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    bin(boxes_[i].low, boxes_[i].high, static_cast<std::uint16_t>(i));
  for (std::size_t i = 0; i < cylinders_.size(); ++i) {
    const auto& [centre, radius, top, celsius] = cylinders_[i];
    bin({centre.x() - radius, centre.y() - radius, 0.0}, {centre.x() + radius, centre.y() + radius, top},
        static_cast<std::uint16_t>(kBoxes + i));
  }
}

void HallScene::bin(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::uint16_t object) {
  const Eigen::Vector3d shift(kNx / 2, kNy / 2, 0.0);
  const Eigen::Vector3i limit(kNx - 1, kNy - 1, kNz - 1);
  const Eigen::Vector3i first = (low + shift).array().floor().cast<int>().max(0);
  const Eigen::Vector3i last = (high + shift).array().floor().cast<int>().min(limit.array());
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x)
        bins_[static_cast<std::size_t>((z * kNy + y) * kNx + x)].push_back(object);
    }
  }
}

Hit HallScene::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  Hit nearest = meetHall(origin, direction);
  const Eigen::Vector3d from = origin + Eigen::Vector3d(kNx / 2, kNy / 2, 0.0);
  Eigen::Vector3i cell = from.array().floor().cast<int>();
  const Eigen::Vector3i limit(kNx, kNy, kNz);
  Eigen::Vector3d next, delta;
  Eigen::Vector3i step;
  for (int i = 0; i < 3; ++i) {
    step[i] = direction[i] > 0.0 ? 1 : -1;
    delta[i] = 1.0 / std::abs(direction[i]);
    next[i] = (cell[i] + (step[i] > 0 ? 1 : 0) - from[i]) / direction[i];
  }
  const auto look = [&](const auto& object) {
    const std::optional<Hit> hit = meet(object, origin, direction);
    if (hit && hit->range < nearest.range) nearest = *hit;
  };
  while ((cell.array() >= 0).all() && (cell.array() < limit.array()).all()) {
    for (const std::uint16_t object :
         bins_[static_cast<std::size_t>((cell.z() * kNy + cell.y()) * kNx + cell.x())])
      object < kBoxes ? look(boxes_[object]) : look(cylinders_[object - kBoxes]);
    int axis = 0;
    if (nearest.range <= next.minCoeff(&axis)) break;
    cell[axis] += step[axis];
    next[axis] += delta[axis];
  }
  return nearest;
}

}  // namespace thermovox::bench
