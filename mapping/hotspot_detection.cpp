#include "mapping/hotspot_detection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapping/hot_clusters.hpp"
#include "mapping/local_plane.hpp"
#include "mapping/peak_model.hpp"
#include "mapping/percentile.hpp"
#include "mapping/surface_height.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kFewestCells = 3;
constexpr double kSure = 3.0;              // sigmas
constexpr double kFewestPixels = 9.0;      // 3 x 3
constexpr double kGap = 0.15;              // metres between a spot and its surroundings
constexpr double kBand = 2.0;              // cells off its plane that a peak is fitted to
constexpr double kMostBlur = 0.75;         // of the variance of a peak's shape that blur may make up
constexpr std::size_t kEnough = 12;        // samples seen from the front, to leave out the others
constexpr double kLeastModelError = 0.01;  // of a peak's rise, by which each sample may differ from the model
constexpr double kShapeError = 0.01;       // of a peak's rise, by which no real one is a Gaussian
constexpr double kSurfaceError = 1e-3;     // metres: what a surface differs from a quadric by
constexpr double kExplained = 0.3;         // of its excess that a piece may differ from a model by

/// A cluster on the way to a hot spot.
struct Candidate {
  HotCluster cells;
  LocalReference reference;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< weighted by the excess
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double spread2 = 0.0;  ///< mean squared distance from the centroid, m^2
  double weights = 0.0;  ///< effective number of cells
  double hottest = 0.0;
  std::optional<PeakFit> fit;
};

/// One mission's layer and what of it is hot.
class Detection {
 public:
  Detection(const SurfaceLayer& layer, const HotspotCriteria& criteria, const CameraSight& camera)
      : layer_(layer),
        criteria_(criteria),
        camera_(camera),
        clusters_(hotClusters(layer, criteria)),
        hot_(layer.samples().size()) {
    for (const HotCluster& cluster : clusters_) {
      for (const std::uint32_t i : cluster) hot_[i] = true;
    }
    std::stable_sort(clusters_.begin(), clusters_.end(),
                     [&](const HotCluster& a, const HotCluster& b) { return hottestOf(a) > hottestOf(b); });
  }

  std::vector<Hotspot> run() {
    std::vector<Hotspot> spots;
    for (std::size_t k = 0; k < clusters_.size(); ++k) {
      if (clusters_[k].empty()) continue;
      std::optional<Candidate> candidate = candidateOf(clusters_[k]);
      if (!candidate) continue;
      candidate->fit = fitted(*candidate);
      if (candidate->fit && absorb(k, *candidate)) candidate->fit = fitted(*candidate);
      if (candidate->cells.size() < kFewestCells || !standsOut(*candidate) || !isHot(*candidate)) continue;
      spots.push_back(hotspotOf(*candidate));
    }
    std::stable_sort(spots.begin(), spots.end(),
                     [](const Hotspot& a, const Hotspot& b) { return a.peak.value > b.peak.value; });
    return spots;
  }

 private:
  [[nodiscard]] double hottestOf(const HotCluster& cluster) const {
    double hottest = -1e9;
    for (const std::uint32_t i : cluster) hottest = std::max<double>(hottest, layer_[i].celsius);
    return hottest;
  }

  [[nodiscard]] std::optional<Candidate> candidateOf(const HotCluster& cells) const {
    const std::optional<LocalReference> reference = localReference(layer_, cells, kGap, hot_);
    Candidate candidate{.cells = cells, .hottest = hottestOf(cells)};
    candidate.reference = reference.value_or(LocalReference{coolestOf(cells), 1.0});
    weigh(candidate);
    return candidate;
  }

  [[nodiscard]] double coolestOf(const HotCluster& cluster) const {
    double coolest = 1e9;
    for (const std::uint32_t i : cluster) coolest = std::min<double>(coolest, layer_[i].celsius);
    return coolest;
  }

  void weigh(Candidate& candidate) const {
    double sum = 0.0, squares = 0.0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    const Eigen::Vector3d origin = layer_[candidate.cells.front()].p_world;
    for (const std::uint32_t i : candidate.cells) {
      const double w = std::max(layer_[i].celsius - candidate.reference.celsius, 0.1);
      first += w * (layer_[i].p_world - origin);
      sum += w;
      squares += w * w;
    }
    candidate.centroid = origin + first / sum;
    candidate.weights = sum * sum / squares;
    double second = 0.0;
    for (const std::uint32_t i : candidate.cells) {
      const double w = std::max(layer_[i].celsius - candidate.reference.celsius, 0.1);
      second += w * (layer_[i].p_world - candidate.centroid).squaredNorm();
    }
    candidate.spread2 = second / sum;
    PointSums sums;
    const double radius = std::max(4.0 * layer_.resolution(), 1.5 * std::sqrt(candidate.spread2));
    for (const std::uint32_t i : layer_.within(candidate.centroid, radius)) {
      sums.add(layer_[i].p_world - candidate.centroid);
    }
    if (sums.count >= 6) candidate.normal = localPlane(sums).normal.cast<double>();
  }

  [[nodiscard]] std::optional<PeakFit> fitted(const Candidate& candidate) const {
    const double rise = candidate.hottest - candidate.reference.celsius;
    const double width = std::clamp(std::sqrt(candidate.spread2 / 2.0) * 1.2, 0.6 * layer_.resolution(), 1.0);
    const std::vector<PeakSample> samples = samplesAround(candidate, std::clamp(4.0 * width, 0.25, 1.5));
    if (samples.size() < 6 || !(rise > 0.0)) return std::nullopt;
    PeakPrior prior{.guess = {candidate.centroid, rise, width, candidate.reference.celsius},
                    .normal = candidate.normal};
    prior.blur_sigma = camera_.blur_sigma;
    prior.reference_sigma = std::max(candidate.reference.sigma, 0.5);
    const std::optional<PeakFit> fit = fitPeak(samples, prior);
    if (!fit) return fit;
    // Where the samples follow the model more closely than was feared, what they differ by is its error.
    prior.model_error = std::max(prior.model_error * std::min(fit->misfit, 1.0), kLeastModelError);
    putOnSurface(samples, fit->model, prior);
    const std::optional<PeakFit> closer = fitPeak(samples, prior);
    return closer ? closer : fit;
  }

  [[nodiscard]] std::vector<PeakSample> samplesAround(const Candidate& candidate, double radius) const {
    std::vector<PeakSample> facing, all;
    for (const std::uint32_t i : layer_.within(candidate.centroid, radius)) {
      const SurfaceSample& sample = layer_[i];
      const double off = candidate.normal.dot(sample.p_world - candidate.centroid);
      const bool own = std::binary_search(candidate.cells.begin(), candidate.cells.end(), i);
      if (!own && (hot_[i] || std::abs(off) > kBand * layer_.resolution())) continue;
      all.push_back({sample.p_world, sample.celsius, sample.sigma, sample.returns, blurAt(i, candidate)});
      if (all.back().blur.fromTheFront()) facing.push_back(all.back());
    }
    return facing.size() >= kEnough ? facing : all;
  }

  [[nodiscard]] SurfaceBlur blurAt(std::uint32_t i, const Candidate& candidate) const {
    const Eigen::Vector3f& own = layer_.normal(i);
    const Eigen::Vector3d normal = own.isZero() ? candidate.normal : own.cast<double>();
    return blurOf(layer_[i], normal, camera_);
  }

  /// The peak lies on the surface, which the samples know better than their temperatures do.
  void putOnSurface(const std::vector<PeakSample>& samples, const PeakModel& model, PeakPrior& prior) const {
    prior.guess.centre = model.centre;
    if (prior.normal.isZero()) return;
    std::vector<HeightPoint> near;
    const double radius = std::max(2.0 * model.width, 3.0 * layer_.resolution());
    for (const PeakSample& sample : samples) {
      if (sample.returns > 0 && (sample.p_world - model.centre).norm() < radius) {
        near.push_back({sample.p_world, static_cast<double>(sample.returns)});
      }
    }
    if (const auto height = surfaceHeight(near, model.centre, prior.normal, layer_.resolution())) {
      prior.guess.centre += height->height * prior.normal;
      prior.surface_sigma = std::hypot(height->sigma, kSurfaceError);
    }
  }

  /// Takes the weaker clusters that the model explains.
  bool absorb(std::size_t k, Candidate& candidate) {
    bool any = false;
    const PeakModel& model = candidate.fit->model;
    for (std::size_t other = k + 1; other < clusters_.size(); ++other) {
      HotCluster& piece = clusters_[other];
      const bool explained = !piece.empty() && std::all_of(piece.begin(), piece.end(), [&](std::uint32_t i) {
        const double excess = layer_[i].celsius - candidate.reference.celsius;
        return std::abs(layer_[i].celsius - model.at(layer_[i].p_world, blurAt(i, candidate))) <
               std::max(kExplained * excess, kSure * layer_[i].sigma);
      });
      if (!explained) continue;
      candidate.cells.insert(candidate.cells.end(), piece.begin(), piece.end());
      piece.clear();
      any = true;
    }
    std::sort(candidate.cells.begin(), candidate.cells.end());
    return any;
  }

  [[nodiscard]] bool standsOut(const Candidate& candidate) const {
    const auto sure = [&](std::uint32_t i) {
      return layer_[i].celsius - candidate.reference.celsius > kSure * layer_[i].sigma;
    };
    return std::any_of(candidate.cells.begin(), candidate.cells.end(), sure);
  }

  /// By the criteria, now that its own surroundings are known. What lies on a surface of which nothing else
  /// was seen has to have the shape of a peak: a warm wall behind something cold is none.
  [[nodiscard]] bool isHot(const Candidate& candidate) const {
    if (criteria_.above && candidate.hottest >= *criteria_.above) return true;
    if (!criteria_.delta || candidate.hottest - candidate.reference.celsius < *criteria_.delta) return false;
    const bool knows_surface = std::any_of(candidate.cells.begin(), candidate.cells.end(),
                                           [&](std::uint32_t i) { return !layer_.normal(i).isZero(); });
    return candidate.fit || candidate.reference.same_surface || !knows_surface;
  }

  [[nodiscard]] Hotspot hotspotOf(const Candidate& candidate) const {
    Hotspot spot;
    describeCells(candidate, spot);
    spot.normal = candidate.normal;
    spot.bias_sigma = camera_.bias_sigma;
    spot.reference = {candidate.reference.celsius, candidate.reference.sigma};
    if (candidate.fit) {
      takeFit(*candidate.fit, spot);
    } else {
      takeCells(candidate, spot);
    }
    if (spot.pixels < kFewestPixels) spot.reads_low = true;
    return spot;
  }

  void describeCells(const Candidate& candidate, Hotspot& spot) const {
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
  [[nodiscard]] double areaOf(const Candidate& candidate) const {
    const double cells = candidate.normal.isZero() ? 1.5 : candidate.normal.cwiseAbs().sum();
    return static_cast<double>(candidate.cells.size()) * layer_.resolution() * layer_.resolution() / cells;
  }

  void takeFit(const PeakFit& fit, Hotspot& spot) const {
    spot.position.p_world = fit.model.centre;
    spot.position.random = fit.covariance.topLeftCorner<3, 3>();
    spot.reference = {fit.model.reference, std::hypot(std::sqrt(fit.covariance(5, 5)), spot.reference.sigma)};
    spot.width = fit.model.width;
    const double blur = std::pow(spot.best_view.range / camera_.focal_px * imageBlur(camera_), 2);
    spot.reads_low = blur > kMostBlur * (blur + spot.width * spot.width);
    spot.peak.value = fit.model.reference + fit.model.rise;
    Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();  // by ln rise and reference
    gradient[3] = fit.model.rise;
    gradient[5] = 1.0;
    const double shape = kShapeError * fit.model.rise;
    spot.peak.sigma = std::hypot(std::sqrt(gradient.dot(fit.covariance * gradient)), shape);
    spot.delta = {fit.model.rise, std::hypot(fit.model.rise * std::sqrt(fit.covariance(3, 3)), shape)};
  }

  void takeCells(const Candidate& candidate, Hotspot& spot) const {
    spot.position.p_world = candidate.centroid;
    const double cell = layer_.resolution() * layer_.resolution() / 12.0;
    spot.position.random = Eigen::Matrix3d::Identity() * (candidate.spread2 / 3.0 / candidate.weights + cell);
    for (const std::uint32_t i : candidate.cells) {
      if (layer_[i].celsius >= candidate.hottest) spot.peak = {layer_[i].celsius, layer_[i].sigma};
    }
    spot.delta = {spot.peak.value - spot.reference.value, std::hypot(spot.peak.sigma, spot.reference.sigma)};
    spot.reads_low = true;
  }

  const SurfaceLayer& layer_;
  const HotspotCriteria& criteria_;
  const CameraSight& camera_;
  std::vector<HotCluster> clusters_;
  std::vector<bool> hot_;
};

}  // namespace

void HotspotCriteria::validate() const {
  if (!above && !delta)
    throw ConfigError("hot spots: expected a temperature (above) or a difference (delta)");
  if (above && !std::isfinite(*above)) throw ConfigError("above: expected a temperature in Celsius");
  if (delta && !(*delta > 0.0 && std::isfinite(*delta)))
    throw ConfigError("delta: expected a difference of more than 0 Celsius");
}

std::vector<Hotspot> findHotspots(const SurfaceLayer& layer, const HotspotCriteria& criteria,
                                  const CameraSight& camera) {
  criteria.validate();
  if (layer.samples().empty()) return {};
  return Detection(layer, criteria, camera).run();
}

}  // namespace thermovox
