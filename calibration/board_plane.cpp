#include "calibration/board_plane.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace thermovox {
namespace {

constexpr double kOutlier = 3.5;       // robust sigmas
constexpr double kPriorReturns = 4.0;  // how many returns the rig's sigma counts for
constexpr double kLargestRange = 1e6;  // metres
constexpr double kNothing = 1e-9;      // of a matrix: rounding

struct Ray {
  Eigen::Vector3d direction;
  double range;
};

std::vector<Ray> raysOf(const std::vector<Eigen::Vector3d>& returns) {
  std::vector<Ray> rays;
  for (const Eigen::Vector3d& p : returns) rays.push_back({p.normalized(), p.norm()});
  return rays;
}

/// The plane through the rays, by Gauss and Newton on the ranges from the linear one (1 / r = q . u).
std::optional<Eigen::Vector3d> fitted(const std::vector<Ray>& rays, int dimensions) {
  if (static_cast<int>(rays.size()) < dimensions) return std::nullopt;
  Eigen::MatrixXd rows(rays.size(), dimensions);
  Eigen::VectorXd values(rays.size());
  Eigen::VectorXd q = Eigen::VectorXd::Zero(dimensions);
  for (int round = 0; round < 6; ++round) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Eigen::VectorXd u = rays[i].direction.head(dimensions);
      const double rho = round == 0 ? rays[i].range : 1.0 / q.dot(u);
      rows.row(row) = rho * rho * u.transpose();
      values[row] = round == 0 ? rho : rho - rays[i].range;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows);
    if (qr.rank() < dimensions) return std::nullopt;
    const Eigen::VectorXd step = qr.solve(values);
    q += step;
    for (const Ray& ray : rays) {
      if (!(q.dot(ray.direction.head(dimensions)) * kLargestRange > 1.0)) return std::nullopt;
    }
    if (round > 0 && step.norm() < 1e-10 * q.norm()) break;
  }
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  plane.head(dimensions) = q;
  return plane;
}

double residualOf(const Ray& ray, const Eigen::Vector3d& q) {
  return ray.range - 1.0 / q.dot(ray.direction);
}

double robustSigma(const std::vector<Ray>& rays, const Eigen::Vector3d& q) {
  std::vector<double> sizes;
  for (const Ray& ray : rays) sizes.push_back(std::abs(residualOf(ray, q)));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return 1.4826 * *middle;
}

/// How many times the variance of a fit is larger than that of rays that err independently: those of one
/// channel of a multi-beam laser err together. The mean square of the channels' means over that within them
/// (an analysis of variance); 1 where chance explains it, or rays do not come in channels.
double channelEffect(const std::vector<Ray>& rays, const Eigen::Vector3d& q) {
  constexpr double kChannel = 0.002;              // radians of elevation between two of them
  constexpr std::size_t kFewest = 4;              // channels, and rays in each on the average
  constexpr double kChance = 2.0;                 // a ratio that chance makes
  std::vector<std::pair<double, double>> sorted;  // elevation, residual
  for (const Ray& ray : rays) sorted.emplace_back(std::asin(ray.direction.z()), residualOf(ray, q));
  std::sort(sorted.begin(), sorted.end());
  double between = 0.0, within = 0.0;
  std::size_t channels = 0;
  for (std::size_t first = 0, i = 1; i <= sorted.size(); ++i) {
    if (i < sorted.size() && sorted[i].first - sorted[i - 1].first < kChannel) continue;
    double mean = 0.0;
    const auto count = static_cast<double>(i - first);
    for (std::size_t k = first; k < i; ++k) mean += sorted[k].second / count;
    for (std::size_t k = first; k < i; ++k) within += std::pow(sorted[k].second - mean, 2);
    between += count * mean * mean;
    ++channels;
    first = i;
  }
  if (channels < kFewest || sorted.size() < (kFewest + 1) * channels) return 1.0;
  const double freedom = static_cast<double>(channels) - 3.0;
  const double ratio = (between / freedom) / (within / static_cast<double>(sorted.size() - channels));
  return ratio > kChance ? ratio : 1.0;
}

/// The rays whose directions lie farthest out: in the middle, then each time the one farthest from those.
std::vector<std::size_t> spread(const std::vector<Ray>& rays, std::size_t count) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) middle += ray.direction;
  middle.normalize();
  std::vector<double> distances(rays.size(), 4.0);
  std::vector<std::size_t> chosen;
  Eigen::Vector3d last = middle;
  while (chosen.size() < std::min(count, rays.size())) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      distances[i] = std::min(distances[i], (rays[i].direction - last).squaredNorm());
    }
    const auto farthest = std::max_element(distances.begin(), distances.end());
    chosen.push_back(static_cast<std::size_t>(farthest - distances.begin()));
    last = rays[chosen.back()].direction;
  }
  return chosen;
}

/// See PlaneMoments: the decomposition of [rho^2 u, 1 | e] / sigma.
void decompose(PlaneMoments& moments, const std::vector<Ray>& rays) {
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(std::max<Eigen::Index>(5, static_cast<Eigen::Index>(rays.size())), 5);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    const double rho = 1.0 / moments.inverse_plane.dot(ray.direction);
    rows.row(static_cast<Eigen::Index>(i)) << rho * rho * ray.direction.transpose(), 1.0,
        residualOf(ray, moments.inverse_plane);
  }
  rows /= moments.sigma * std::sqrt(moments.channel_effect);
  const Eigen::MatrixXd triangle = Eigen::HouseholderQR<Eigen::MatrixXd>(rows).matrixQR().topRows(5);
  const Eigen::MatrixXd upper = triangle.triangularView<Eigen::Upper>();
  moments.slope = upper.topLeftCorner<4, 4>();
  moments.offset = upper.block<4, 1>(0, 4);
  // What the rays do not span leaves rows that say nothing; their offsets are of the noise alone.
  for (int row = 0; row < 4; ++row) {
    if (moments.slope.row(row).norm() > kNothing * moments.slope.norm()) continue;
    moments.slope.row(row).setZero();
    moments.offset[row] = 0.0;
  }
}

}  // namespace

std::optional<PlaneMoments> planeMoments(const std::vector<Eigen::Vector3d>& returns_laser, LaserKind kind,
                                         double range_sigma) {
  const int dimensions = dimensionsOf(kind);
  std::vector<Ray> rays = raysOf(returns_laser);
  std::optional<Eigen::Vector3d> plane;
  for (int round = 0; round < 4; ++round) {
    plane = fitted(rays, dimensions);
    if (!plane) return std::nullopt;
    const double gate = kOutlier * std::max({robustSigma(rays, *plane), 0.1 * range_sigma, 1e-5});
    const auto kept = std::remove_if(
        rays.begin(), rays.end(), [&](const Ray& ray) { return std::abs(residualOf(ray, *plane)) > gate; });
    if (kept == rays.end()) break;
    rays.erase(kept, rays.end());
  }
  PlaneMoments moments;
  moments.inverse_plane = *plane;
  moments.returns = static_cast<int>(rays.size());
  moments.outliers = static_cast<int>(returns_laser.size() - rays.size());
  double squares = kPriorReturns * std::max(range_sigma * range_sigma, 1e-10);
  for (const Ray& ray : rays) squares += std::pow(residualOf(ray, *plane), 2);
  const double freedom = kPriorReturns + static_cast<double>(rays.size()) - dimensions;
  moments.sigma = std::sqrt(squares / freedom);
  moments.channel_effect = kind == LaserKind::cloud ? channelEffect(rays, *plane) : 1.0;
  decompose(moments, rays);
  for (const std::size_t i : spread(rays, static_cast<std::size_t>(dimensions + 1))) {
    moments.corner_rays.push_back(rays[i].direction);
    moments.corner_ranges.push_back(1.0 / plane->dot(rays[i].direction));
  }
  return moments;
}

}  // namespace thermovox
