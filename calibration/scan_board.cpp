#include "calibration/scan_board.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/board_plane.hpp"

namespace thermovox {
namespace {

constexpr double kSameAngle = 1e-5;    // radians: one ray of several sweeps
constexpr double kJump = 0.04;         // metres from ray to ray: two surfaces
constexpr double kSteep = 0.08;        // of the range, likewise: steep surfaces far away
constexpr double kShortest = 0.08;     // metres of board that a line is fitted to
constexpr double kLongest = 1.1;       // of the plate's diagonal
constexpr std::size_t kFewest = 6;     // rays
constexpr double kNotStraight = 0.02;  // metres rms

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector2d endOf(const ScanRay& ray) {
  return {ray.range * std::cos(ray.angle), ray.range * std::sin(ray.angle)};
}

/// Root mean square of the distances from the best line through the rays [first, last).
double bend(const std::vector<ScanRay>& rays, std::size_t first, std::size_t last) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  const auto count = static_cast<double>(last - first);
  for (std::size_t i = first; i < last; ++i) sum += endOf(rays[i]);
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector2d d = endOf(rays[i]) - sum / count;
    squares += d * d.transpose();
  }
  const double trace = squares.trace(), det = squares.determinant();
  const double least = 0.5 * trace - std::sqrt(std::max(0.0, 0.25 * trace * trace - det));
  return std::sqrt(std::max(0.0, least) / count);
}

struct Piece {
  std::size_t first, last;  ///< rays
  double score;             ///< more is better
};

/// A piece that ends on both sides at something farther away is an object by itself.
Piece pieceOf(const std::vector<ScanRay>& rays, std::size_t first, std::size_t last,
              const Eigen::Vector2d& plate) {
  const double length = (endOf(rays[last - 1]) - endOf(rays[first])).norm();
  Piece piece{first, last, std::min(1.0, length / plate.minCoeff())};
  if (first > 0 && rays[first - 1].range > rays[first].range) piece.score += 1.0;
  if (last < rays.size() && rays[last].range > rays[last - 1].range) piece.score += 1.0;
  return piece;
}

}  // namespace

std::vector<ScanRay> scanRays(const std::vector<Eigen::Vector3d>& returns_laser) {
  std::vector<std::size_t> order(returns_laser.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> angles;
  for (const Eigen::Vector3d& p : returns_laser) angles.push_back(std::atan2(p.y(), p.x()));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
  std::vector<ScanRay> rays;
  for (const std::size_t i : order) {
    if (rays.empty() || angles[i] - rays.back().angle > kSameAngle) rays.push_back({angles[i], 0.0, {}});
    rays.back().returns.push_back(i);
  }
  for (ScanRay& ray : rays) {
    std::vector<double> ranges;
    for (const std::size_t i : ray.returns) ranges.push_back(returns_laser[i].norm());
    ray.range = medianOf(std::move(ranges));
  }
  return rays;
}

std::vector<std::vector<Eigen::Vector3d>> boardsInScan(const std::vector<Eigen::Vector3d>& returns_laser,
                                                       const Eigen::Vector2d& plate) {
  const std::vector<ScanRay> rays = scanRays(returns_laser);
  std::vector<Piece> pieces;
  for (std::size_t first = 0, i = 1; i <= rays.size(); ++i) {
    const bool ends = i == rays.size() ||
                      std::abs(rays[i].range - rays[i - 1].range) > std::max(kJump, kSteep * rays[i].range);
    if (!ends) continue;
    const double length = (endOf(rays[i - 1]) - endOf(rays[first])).norm();
    if (i - first >= kFewest && length >= kShortest && length <= kLongest * plate.norm() &&
        bend(rays, first, i) < kNotStraight)
      pieces.push_back(pieceOf(rays, first, i, plate));
    first = i;
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.score > b.score; });
  std::vector<std::vector<Eigen::Vector3d>> boards;
  for (const Piece& piece : pieces) {
    boards.emplace_back();
    for (std::size_t ray = piece.first; ray < piece.last; ++ray) {
      for (const std::size_t i : rays[ray].returns) boards.back().push_back(returns_laser[i]);
    }
  }
  return boards;
}

}  // namespace thermovox
