#include "calibration/board_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "calibration/scan_board.hpp"

namespace thermovox {
namespace {

constexpr double kOnBoard = 4.5;     // sigmas off the plane
constexpr double kBehind = 0.06;     // metres behind it: another surface
constexpr double kNear = 0.03;       // metres: a crossing is so near to its edge
constexpr double kDoubt = 0.03;      // metres: the next edge is so much farther
constexpr double kSpot = 0.001;      // metres, one sigma: what is unsharp besides the gap of the rays
constexpr double kBeamSpot = 0.003;  // radians, one sigma of where in a beam (8 mrad wide) an edge is
constexpr double kWidestGap = 0.05;  // metres between the two rays on the board
constexpr double kGrazing = 0.34;    // cosine of the incidence

enum class Where { on, behind, neither };

/// A return against the board.
struct Sighting {
  Eigen::Vector3d ray;  ///< unit, laser frame
  Eigen::Vector2d hit;  ///< of the ray on the board's plane, metres
  double cosine = 0.0;  ///< of the incidence
  Where where = Where::neither;
};

class Plate {
 public:
  Plate(const Pose& T_laser_board, const CalibrationBoard& board, double range_sigma)
      : R_board_laser_(T_laser_board.matrix().transpose()),
        origin_(-(R_board_laser_ * T_laser_board.translation)),
        half_(0.5 * board.width, 0.5 * board.height),
        range_sigma_(range_sigma) {}

  [[nodiscard]] Sighting sightingOf(const Eigen::Vector3d& ray_laser, double range) const {
    Sighting sighting{.ray = ray_laser, .hit = Eigen::Vector2d::Zero()};
    const Eigen::Vector3d ray = R_board_laser_ * ray_laser;
    sighting.cosine = ray.z();
    if (!(ray.z() > kGrazing)) return sighting;
    const double reach = -origin_.z() / ray.z();
    sighting.hit = (origin_ + reach * ray).head<2>();
    const Eigen::Array2d beyond = sighting.hit.array().abs() - half_.array();
    if (std::abs(range - reach) < kOnBoard * range_sigma_ && beyond.maxCoeff() < kNear) {
      sighting.where = Where::on;
    } else if (range > reach + std::max(kBehind, 2.0 * kOnBoard * range_sigma_)) {
      sighting.where = Where::behind;
    }
    return sighting;
  }

  /// The crossing between two rays; none where it is not near one edge alone.
  [[nodiscard]] std::optional<EdgeCrossing> between(const Sighting& on, const Sighting& off) const {
    const Eigen::Vector2d gap = off.hit - on.hit, middle = 0.5 * (on.hit + off.hit);
    if (gap.norm() > kWidestGap) return std::nullopt;
    std::optional<EdgeCrossing> crossing = at((on.ray + off.ray).normalized(), middle);
    if (!crossing) return std::nullopt;
    crossing->sigma = std::hypot(gap[crossing->axis] / std::sqrt(12.0), kSpot);
    return crossing;
  }

  /// Where a crossing's ray meets the board on the axis across its edge, metres.
  [[nodiscard]] double acrossOf(const EdgeCrossing& crossing) const {
    const Eigen::Vector3d ray = R_board_laser_ * crossing.ray;
    return origin_[crossing.axis] - origin_.z() / ray.z() * ray[crossing.axis];
  }

  /// A ray that is itself on an edge.
  [[nodiscard]] std::optional<EdgeCrossing> at(const Eigen::Vector3d& ray, const Eigen::Vector2d& hit) const {
    std::array<double, 4> off{};
    for (int i = 0; i < 4; ++i) off[static_cast<std::size_t>(i)] = std::abs(hit[i / 2] - edge(i));
    const auto nearest = std::min_element(off.begin(), off.end());
    const int side = static_cast<int>(nearest - off.begin());
    const int along = 1 - side / 2;
    for (int i = 0; i < 4; ++i) {
      if (i != side && off[static_cast<std::size_t>(i)] < *nearest + kDoubt) return std::nullopt;
    }
    if (*nearest > kNear || std::abs(hit[along]) > half_[along]) return std::nullopt;
    return EdgeCrossing{.ray = ray, .axis = side / 2, .place = edge(side), .sigma = kSpot};
  }

 private:
  [[nodiscard]] double edge(int side) const { return (side % 2 == 0 ? -1.0 : 1.0) * half_[side / 2]; }

  Eigen::Matrix3d R_board_laser_;
  Eigen::Vector3d origin_;
  Eigen::Vector2d half_;
  double range_sigma_;
};

std::vector<EdgeCrossing> scanCrossings(const ReturnSet& returns, const Plate& plate) {
  std::vector<Sighting> sightings;
  for (const ScanRay& ray : scanRays(returns)) {
    const Eigen::Vector3d direction(std::cos(ray.angle), std::sin(ray.angle), 0.0);
    sightings.push_back(plate.sightingOf(direction, ray.range));
  }
  std::vector<EdgeCrossing> crossings;
  // One ray between the two may be a mixture of both surfaces.
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    for (const std::size_t apart : {std::size_t{1}, std::size_t{2}}) {
      if (i + apart >= sightings.size()) continue;
      const Sighting &a = sightings[i], &b = sightings[i + apart];
      if (apart == 2 && sightings[i + 1].where != Where::neither) continue;
      const bool out = a.where == Where::on && b.where == Where::behind;
      const bool in = a.where == Where::behind && b.where == Where::on;
      if (!out && !in) continue;
      if (const auto crossing = out ? plate.between(a, b) : plate.between(b, a))
        crossings.push_back(*crossing);
    }
  }
  return crossings;
}

/// Place of the nearest ray among others; none if there are none.
std::optional<std::size_t> nearestOf(const Sighting& to, const std::vector<Sighting>& others) {
  std::optional<std::size_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < others.size(); ++i) {
    const double distance = (others[i].ray - to.ray).squaredNorm();
    if (!(distance < least)) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

std::vector<EdgeCrossing> cloudCrossings(const ReturnSet& returns, const Plate& plate,
                                         const CalibrationBoard& board) {
  std::vector<Sighting> on, behind;
  const Eigen::Array2d half(0.5 * board.width, 0.5 * board.height);
  for (const Eigen::Vector3d& p : returns) {
    const Sighting sighting = plate.sightingOf(p.normalized(), p.norm());
    if (sighting.where == Where::neither) continue;
    const Eigen::Array2d inside = half - sighting.hit.array().abs();
    if (inside.minCoeff() < -kWidestGap - kNear || inside.minCoeff() > kWidestGap + kNear) continue;
    (sighting.where == Where::on ? on : behind).push_back(sighting);
  }
  std::vector<EdgeCrossing> crossings;
  for (std::size_t i = 0; i < on.size(); ++i) {
    const std::optional<std::size_t> off = nearestOf(on[i], behind);
    if (!off || nearestOf(behind[*off], on) != i) continue;
    if (const auto crossing = plate.between(on[i], behind[*off])) crossings.push_back(*crossing);
  }
  return crossings;
}

/// Readings that jump: at least a tenth from the board and a tenth from behind it.
std::vector<EdgeCrossing> beamCrossings(const ReturnSet& returns, const Plate& plate) {
  constexpr std::size_t kFewest = 3;
  std::size_t on = 0, behind = 0;
  for (const Eigen::Vector3d& p : returns) {
    const Where where = plate.sightingOf(Eigen::Vector3d::UnitX(), p.norm()).where;
    on += where == Where::on ? 1 : 0;
    behind += where == Where::behind ? 1 : 0;
  }
  const std::size_t tenth = std::max(kFewest, returns.size() / 10);
  if (on < tenth || behind < tenth) return {};
  const Sighting beam = plate.sightingOf(Eigen::Vector3d::UnitX(), 0.0);
  std::optional<EdgeCrossing> crossing = plate.at(Eigen::Vector3d::UnitX(), beam.hit);
  if (!crossing) return {};
  crossing->sigma = kBeamSpot * returns.front().norm() / beam.cosine;
  return {*crossing};
}

std::vector<EdgeCrossing> crossingsOf(const ReturnSet& returns, LaserKind kind, const Plate& plate,
                                      const CalibrationBoard& board) {
  switch (kind) {
    case LaserKind::beam:
      return beamCrossings(returns, plate);
    case LaserKind::scan:
      return scanCrossings(returns, plate);
    case LaserKind::cloud:
      break;
  }
  return cloudCrossings(returns, plate, board);
}

/// See EdgeSide: the variance of gaps met anywhere, less that of the crossings about their mean.
double offsetSigma(const std::vector<EdgeCrossing>& crossings, const Plate& plate) {
  if (crossings.size() < 2) return 0.0;
  double mean = 0.0, squares = 0.0, expected = 0.0;
  const auto count = static_cast<double>(crossings.size());
  for (const EdgeCrossing& crossing : crossings) mean += plate.acrossOf(crossing) / count;
  for (const EdgeCrossing& crossing : crossings) {
    squares += std::pow(plate.acrossOf(crossing) - mean, 2);
    expected += crossing.sigma * crossing.sigma / count;
  }
  return std::sqrt(std::max(0.0, expected - squares / (count - 1.0)));
}

}  // namespace

std::vector<EdgeSide> edgeSides(const ReturnSet& returns_laser, LaserKind kind, const Pose& T_laser_board,
                                const CalibrationBoard& board, double range_sigma) {
  if (!(board.width > 0.0 && board.height > 0.0)) return {};
  const Plate plate(T_laser_board, board, range_sigma);
  const std::vector<EdgeCrossing> crossings = crossingsOf(returns_laser, kind, plate, board);
  std::vector<EdgeSide> sides;
  for (const int axis : {0, 1}) {
    for (const double outwards : {-1.0, 1.0}) {
      EdgeSide side;
      for (const EdgeCrossing& crossing : crossings) {
        if (crossing.axis == axis && crossing.place * outwards > 0.0) side.crossings.push_back(crossing);
      }
      if (side.crossings.empty()) continue;
      side.offset_sigma = offsetSigma(side.crossings, plate);
      sides.push_back(std::move(side));
    }
  }
  return sides;
}

}  // namespace thermovox
