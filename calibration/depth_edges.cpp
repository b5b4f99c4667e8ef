#include "calibration/depth_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "calibration/sweep_neighbours.hpp"

namespace thermovox {
namespace {

constexpr double kLeastJump = 0.25;         // metres
constexpr double kLeastShare = 0.05;        // of the nearer range
constexpr double kSlopesInJump = 4.0;       // times what the range changes by beside the jump
constexpr double kNeighbouringSteps = 1.5;  // of the scan's angles: farther apart are no neighbours
constexpr Duration kBeamPause = std::chrono::milliseconds(60);  // a beam's readings are no neighbours beyond

/// A return and its neighbour on the side away from the other one.
struct Side {
  const LaserReturn* at = nullptr;
  const LaserReturn* behind = nullptr;
};

double step(const Side& side) {
  return std::abs(side.at->range() - side.behind->range());
}

/// The edge between two neighbouring returns, if there is one.
std::optional<DepthEdge> edgeOf(const Side& a, const Side& b) {
  const bool a_near = a.at->range() < b.at->range();
  const Side& near = a_near ? a : b;
  const Side& past = a_near ? b : a;
  const double range = near.at->range();
  const double jump = past.at->range() - range;
  if (!(jump > std::max(kLeastJump, kLeastShare * range))) return std::nullopt;
  if (near.behind == nullptr || !(kSlopesInJump * step(near) < jump)) return std::nullopt;
  return DepthEdge{.near_stamp = near.at->stamp,
                   .past_stamp = past.at->stamp,
                   .near_laser = near.at->p_laser,
                   .past_laser = past.at->p_laser * (range / past.at->range())};
}

/// Edges between successive returns, where `adjacent` says that they are neighbours.
template <typename Adjacent>
std::vector<DepthEdge> edgesInOrder(std::span<const LaserReturn> returns, const Adjacent& adjacent) {
  std::vector<DepthEdge> edges;
  const auto neighbour = [&](std::size_t i, std::size_t j) -> const LaserReturn* {
    return j < returns.size() && adjacent(returns[i], returns[j]) ? &returns[j] : nullptr;
  };
  for (std::size_t i = 0; i + 1 < returns.size(); ++i) {
    if (neighbour(i, i + 1) == nullptr) continue;
    const Side a{&returns[i], i > 0 ? neighbour(i, i - 1) : nullptr};
    const Side b{&returns[i + 1], neighbour(i + 1, i + 2)};
    if (const auto edge = edgeOf(a, b)) edges.push_back(*edge);
  }
  return edges;
}

double angleOf(const LaserReturn& r) {
  return std::atan2(r.p_laser.y(), r.p_laser.x());
}

/// The place in a scan of each return.
std::vector<int> stepsOf(const Reading& sweep, const Laser& laser) {
  std::vector<int> steps;
  for (const LaserReturn& r : sweep.returns) {
    double angle = angleOf(r) - laser.angle_min;
    if (angle < -1e-6) angle += 2.0 * std::numbers::pi;
    steps.push_back(static_cast<int>(std::lround(angle / std::abs(laser.angle_increment))));
  }
  return steps;
}

/// The neighbour in the sweep, on either side, whose range is nearest.
const LaserReturn* bestBeside(const Reading& sweep, const std::vector<int>& steps, std::size_t i) {
  const LaserReturn* best = nullptr;
  const double range = sweep.returns[i].range();
  for (const std::size_t j : {i - 1, i + 1}) {
    if (j >= steps.size() || std::abs(steps[j] - steps[i]) != 1) continue;
    const LaserReturn& other = sweep.returns[j];
    if (best == nullptr || std::abs(other.range() - range) < std::abs(best->range() - range)) best = &other;
  }
  return best;
}

std::vector<DepthEdge> edgesInCloud(const Reading& sweep) {
  std::vector<DepthEdge> edges;
  const std::vector<SweepNeighbours> all = neighboursIn(sweep.returns);
  const auto returnAt = [&](int i) { return i < 0 ? nullptr : &sweep.returns[static_cast<std::size_t>(i)]; };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t side = 0; side < 4; ++side) {
      const LaserReturn* past = returnAt(all[i][side]);
      const LaserReturn& near = sweep.returns[i];
      if (past == nullptr || past->range() < near.range()) continue;  // seen from the nearer one
      if (const auto edge = edgeOf({&near, returnAt(all[i][(side + 2) % 4])}, {past, nullptr}))
        edges.push_back(*edge);
    }
  }
  return edges;
}

}  // namespace

std::vector<DepthEdge> edgesWithin(const Reading& sweep, const Laser& laser) {
  if (laser.kind == LaserKind::cloud) return edgesInCloud(sweep);
  const double reach = kNeighbouringSteps * std::abs(laser.angle_increment);
  return edgesInOrder(sweep.returns, [&](const LaserReturn& a, const LaserReturn& b) {
    const double turn = std::abs(angleOf(a) - angleOf(b));
    return std::min(turn, 2.0 * std::numbers::pi - turn) < reach;
  });
}

std::vector<DepthEdge> edgesBetween(const Reading& earlier, const Reading& later, const Laser& laser) {
  std::vector<DepthEdge> edges;
  const std::vector<int> before = stepsOf(earlier, laser), after = stepsOf(later, laser);
  for (std::size_t i = 0, j = 0; i < before.size() && j < after.size();) {
    if (before[i] == after[j]) {
      const Side a{&earlier.returns[i], bestBeside(earlier, before, i)};
      const Side b{&later.returns[j], bestBeside(later, after, j)};
      if (const auto edge = edgeOf(a, b)) edges.push_back(*edge);
    }
    const bool first_behind = before[i] <= after[j], second_behind = after[j] <= before[i];
    i += first_behind ? 1 : 0;
    j += second_behind ? 1 : 0;
  }
  return edges;
}

std::vector<DepthEdge> edgesAlong(std::span<const LaserReturn> track) {
  return edgesInOrder(track, [](const LaserReturn& a, const LaserReturn& b) {
    return std::chrono::abs(a.stamp - b.stamp) < kBeamPause;
  });
}

}  // namespace thermovox
