#include "mapping/hot_description.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/percentile.hpp"

namespace thermovox {
namespace {

constexpr double kFewestPixels = 9.0;  // 3 x 3
constexpr double kMostBlur = 0.75;     // of the variance of a peak's shape that blur may make up
constexpr double kShapeError = 0.015;  // of a peak's rise, by which no real one is a Gaussian
constexpr double kKnown = 0.8;         // C, sigma of a peak that does not read low

class Description {
 public:
  Description(const SurfaceLayer& layer, const CameraSight& camera) : layer_(layer), camera_(camera) {}

  [[nodiscard]] Hotspot of(const HotCandidate& candidate) const {
    Hotspot spot;
    describeCells(candidate, spot);
    spot.normal = candidate.normal;
    spot.bias_sigma = camera_.bias_sigma;
    spot.reference = {candidate.reference.celsius, candidate.reference.sigma};
    if (candidate.fit && peakIsWithin(candidate, layer_)) {
      takeFit(*candidate.fit, spot);
    } else {
      takeCells(candidate, spot);
    }
    if (spot.pixels < kFewestPixels) spot.is_bound = true;
    return spot;
  }

 private:
  void describeCells(const HotCandidate& candidate, Hotspot& spot) const {
    std::vector<double> temperatures;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e18), high = -low;
    double best = -1.0;
    spot.first_seen = Time::max();
    spot.last_seen = Time::min();
    for (const std::uint32_t i : candidate.cells) {
      const SurfaceSample& sample = layer_[i];
      temperatures.push_back(sample.celsius);
      spot.cells.push_back(sample.key);
      spot.observations += sample.observations;
      spot.first_seen = std::min(spot.first_seen, sample.first);
      spot.last_seen = std::max(spot.last_seen, sample.last);
      const Eigen::Vector3d corner =
          Eigen::Vector3d(sample.key.x, sample.key.y, sample.key.z) * layer_.resolution();
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner + Eigen::Vector3d::Constant(layer_.resolution()));
      const double pixels = cosineOf(sample.best_view) / (sample.best_view.range * sample.best_view.range);
      if (pixels > best) {
        best = pixels;
        spot.best_view = sample.best_view;
        spot.best_seen = sample.p_world;
      }
    }
    std::sort(temperatures.begin(), temperatures.end());
    spot.hottest_cell = temperatures.back();
    spot.p95 = percentile(temperatures, 0.95);
    for (const double t : temperatures) spot.mean += t / static_cast<double>(temperatures.size());
    spot.extent = high - low;
    spot.area = areaOf(candidate);
    spot.pixels = spot.area * best * camera_.focal_px * camera_.focal_px;
  }

  static double cosineOf(const SurfaceCell::View& view) {
    return std::isnan(view.incidence) ? 1.0 : std::max(std::cos(static_cast<double>(view.incidence)), 0.0);
  }

  /// A plane with normal n goes through (|nx| + |ny| + |nz|) / edge^2 cells a square metre.
  [[nodiscard]] double areaOf(const HotCandidate& candidate) const {
    const double cells = candidate.normal.isZero() ? 1.5 : candidate.normal.cwiseAbs().sum();
    return static_cast<double>(candidate.cells.size()) * layer_.resolution() * layer_.resolution() / cells;
  }

  void takeFit(const PeakFit& fit, Hotspot& spot) const {
    spot.position.p_world = fit.model.centre;
    spot.position.random = fit.covariance.topLeftCorner<3, 3>();
    spot.reference = {fit.model.reference, std::hypot(std::sqrt(fit.covariance(5, 5)), spot.reference.sigma)};
    spot.width = fit.model.width;
    const double blur = std::pow(spot.best_view.range / camera_.focal_px * imageBlur(camera_), 2);
    spot.is_bound = blur > kMostBlur * (blur + spot.width * spot.width);
    spot.peak.value = fit.model.reference + fit.model.rise;
    Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();  // by ln rise and reference
    gradient[3] = fit.model.rise;
    gradient[5] = 1.0;
    spot.peak.sigma = std::sqrt(gradient.dot(fit.covariance * gradient));
    spot.delta = {fit.model.rise, fit.model.rise * std::sqrt(fit.covariance(3, 3))};
    spot.shape_sigma = kShapeError * fit.model.rise;
  }

  void takeCells(const HotCandidate& candidate, Hotspot& spot) const {
    spot.position.p_world = candidate.centroid;
    const double cell = layer_.resolution() * layer_.resolution() / 12.0;
    spot.position.random = Eigen::Matrix3d::Identity() * (candidate.spread2 / 3.0 / candidate.weights + cell);
    for (const std::uint32_t i : candidate.cells) {
      if (layer_[i].celsius >= candidate.hottest) spot.peak = {layer_[i].celsius, layer_[i].sigma};
    }
    spot.delta = {spot.peak.value - spot.reference.value, std::hypot(spot.peak.sigma, spot.reference.sigma)};
    spot.is_bound = true;
  }

  const SurfaceLayer& layer_;
  const CameraSight& camera_;
};

}  // namespace

Hotspot hotspotOf(const HotCandidate& candidate, const SurfaceLayer& layer, const CameraSight& camera) {
  return Description(layer, camera).of(candidate);
}

double Hotspot::peakSigma() const {
  return std::hypot(peak.sigma, bias_sigma, shape_sigma);
}

double Hotspot::deltaSigma() const {
  return std::hypot(delta.sigma, shape_sigma);
}

bool Hotspot::readsLow() const {
  return is_bound || peak.sigma > kKnown;
}

}  // namespace thermovox
