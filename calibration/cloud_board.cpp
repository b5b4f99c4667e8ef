#include "calibration/cloud_board.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <random>

namespace thermovox {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t kSeeds = 300;   // spheres, all over the cloud
constexpr int kTrials = 40;           // planes tried in a sphere
constexpr double kThick = 0.03;       // metres either side of a plane: three sigmas of most lasers
constexpr double kSize = 0.15;        // of a side: how far a rectangle may be off
constexpr double kLeastFilled = 0.7;  // of the rectangle's area, by the points' hull
constexpr std::size_t kFewest = 20;   // points
constexpr double kSameMiddle = 0.3;   // of the plate's diagonal: one board twice

Points within(const Points& points, const Eigen::Vector3d& middle, double radius) {
  Points near;
  for (const Eigen::Vector3d& p : points) {
    if ((p - middle).squaredNorm() < radius * radius) near.push_back(p);
  }
  return near;
}

struct FlatPiece {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Points points;
};

/// The best plane through some points, and those that lie on it.
FlatPiece onPlane(const Points& all, const Points& some) {
  FlatPiece piece;
  for (const Eigen::Vector3d& p : some) piece.middle += p / static_cast<double>(some.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : some) scatter += (p - piece.middle) * (p - piece.middle).transpose();
  piece.normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  for (const Eigen::Vector3d& p : all) {
    if (std::abs(piece.normal.dot(p - piece.middle)) < kThick) piece.points.push_back(p);
  }
  return piece;
}

/// RANSAC: three points make a plane, that with the most points is fitted to them.
std::optional<FlatPiece> flattest(const Points& points, std::mt19937_64& random) {
  if (points.size() < kFewest) return std::nullopt;
  std::size_t most = 0;
  Points best;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 150);  // counted are at most 300
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d& a = points[random() % points.size()];
    const Eigen::Vector3d& b = points[random() % points.size()];
    const Eigen::Vector3d& c = points[random() % points.size()];
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    if (!normal.allFinite()) continue;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); i += step) {
      if (std::abs(normal.dot(points[i] - a)) < kThick) ++count;
    }
    if (count <= most) continue;
    most = count;
    best.clear();
    for (const Eigen::Vector3d& p : points) {
      if (std::abs(normal.dot(p - a)) < kThick) best.push_back(p);
    }
  }
  if (best.size() < kFewest) return std::nullopt;
  return onPlane(points, best);
}

/// The largest distance from a value to the next: how far apart a laser's lines are.
double widestGap(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double widest = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) widest = std::max(widest, values[i] - values[i - 1]);
  return widest;
}

/// How well the points fill a rectangle of the plate's size: 0 not at all, at most 1.
double likeness(const FlatPiece& piece, const SoughtPlate& plate) {
  if (piece.points.size() < kFewest) return 0.0;
  const Eigen::Vector3d x = piece.normal.unitOrthogonal(), y = piece.normal.cross(x);
  std::vector<cv::Point2f> flat, hull;
  for (const Eigen::Vector3d& p : piece.points) {
    const Eigen::Vector3d d = p - piece.middle;
    flat.emplace_back(static_cast<float>(d.dot(x)), static_cast<float>(d.dot(y)));
  }
  cv::convexHull(flat, hull);
  const cv::RotatedRect box = cv::minAreaRect(hull);
  const double area = static_cast<double>(box.size.area());
  if (!(area > 0.0) || cv::contourArea(hull) < kLeastFilled * area) return 0.0;
  const double turn = box.angle * CV_PI / 180.0;
  std::vector<double> along, across;
  for (const cv::Point2f& p : flat) {
    along.push_back(p.x * std::cos(turn) + p.y * std::sin(turn));
    across.push_back(p.y * std::cos(turn) - p.x * std::sin(turn));
  }
  std::array<std::pair<double, double>, 2> sides{
      {{box.size.width, widestGap(std::move(along))}, {box.size.height, widestGap(std::move(across))}}};
  std::sort(sides.begin(), sides.end());
  const std::array<double, 2> wanted{plate.sides.minCoeff(), plate.sides.maxCoeff()};
  double worst = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto [side, gap] = sides[i];
    if (gap > 0.35 * wanted[i]) return 0.0;
    // The outermost lines of the laser are up to a gap within the edges.
    const double off = std::max(side - plate.most * wanted[i], wanted[i] - side - 1.5 * gap);
    worst = std::max(worst, off / (kSize * wanted[i]));
  }
  return std::max(0.0, 1.0 - worst);
}

struct Candidate {
  FlatPiece piece;
  double score;
};

void keepApart(std::vector<Candidate>& candidates, Candidate candidate, double apart) {
  for (Candidate& other : candidates) {
    if ((other.piece.middle - candidate.piece.middle).norm() > apart) continue;
    if (candidate.score > other.score) other = std::move(candidate);
    return;
  }
  candidates.push_back(std::move(candidate));
}

}  // namespace

std::vector<Points> boardsInCloud(const Points& returns_laser, const SoughtPlate& plate) {
  const double radius = 0.5 * plate.most * plate.sides.norm() * (1.0 + kSize);
  std::mt19937_64 random(1);
  std::vector<Candidate> candidates;
  const std::size_t step = std::max<std::size_t>(1, returns_laser.size() / kSeeds);
  for (std::size_t seed = 0; seed < returns_laser.size(); seed += step) {
    Eigen::Vector3d middle = returns_laser[seed];
    const bool known = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
      return (candidate.piece.middle - middle).norm() < kSameMiddle * plate.sides.norm();
    });
    if (known) continue;
    std::optional<FlatPiece> piece;
    for (int round = 0; round < 3; ++round) {  // the sphere moves to the middle of what it found
      piece = flattest(within(returns_laser, middle, radius), random);
      if (!piece || (piece->middle - middle).norm() < 0.02 * radius) break;
      middle = piece->middle;
    }
    if (!piece) continue;
    const double score = likeness(*piece, plate);
    if (score > 0.0) keepApart(candidates, {*std::move(piece), score}, kSameMiddle * plate.sides.norm());
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Points> boards;
  for (Candidate& candidate : candidates) boards.push_back(std::move(candidate.piece.points));
  return boards;
}

}  // namespace thermovox
