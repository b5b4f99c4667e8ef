#include "mapping/hotspot_detection.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "mapping/hot_candidate.hpp"
#include "mapping/hot_clusters.hpp"
#include "mapping/hot_description.hpp"
#include "mapping/local_plane.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kFewestCells = 3;
constexpr std::size_t kForNormal = 6;     // cells
constexpr double kSure = 3.0;             // sigmas
constexpr double kGap = 0.15;             // metres between a spot and its surroundings
constexpr double kSurePeak = 3.0;         // sigmas
constexpr double kMostPutBack = 1.7;      // times what was seen of a rise
constexpr std::size_t kPatch = 16;        // cells that need no shape
constexpr std::uint64_t kConfirmed = 12;  // temperatures that need no shape
constexpr std::size_t kProbes = 500;      // samples
constexpr double kLines = 0.2;            // of the probes on a known surface
constexpr double kReach = 3.5;            // widths from its centre that a peak may still warm
constexpr double kExplained = 0.3;        // of its excess that a piece may differ from a model by

/// One mission's layer and what of it is hot.
class Detection {
 public:
  Detection(const SurfaceLayer& layer, const HotspotCriteria& criteria, const CameraSight& camera)
      : layer_(layer),
        criteria_(criteria),
        camera_(camera),
        clusters_(hotClusters(layer, criteria)),
        hot_(layer.samples().size()),
        has_lines_only_(hasLinesOnly()) {
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
      HotCandidate candidate = candidateOf(clusters_[k]);
      candidate.fit = fitCandidate(candidate, layer_, camera_, hot_);
      if (candidate.fit && absorb(k, candidate)) {
        if (const auto refit = fitCandidate(candidate, layer_, camera_, hot_)) candidate.fit = refit;
      }
      if (candidate.cells.size() < kFewestCells || !standsOut(candidate) || !isHot(candidate)) continue;
      spots.push_back(hotspotOf(candidate, layer_, camera_));
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

  [[nodiscard]] HotCandidate candidateOf(const HotCluster& cells) const {
    const std::optional<LocalReference> reference = localReference(layer_, cells, kGap, hot_);
    HotCandidate candidate{.cells = cells, .hottest = hottestOf(cells)};
    candidate.reference = reference.value_or(LocalReference{coolestOf(cells), 1.0});
    weigh(candidate);
    return candidate;
  }

  [[nodiscard]] double coolestOf(const HotCluster& cluster) const {
    double coolest = 1e9;
    for (const std::uint32_t i : cluster) coolest = std::min<double>(coolest, layer_[i].celsius);
    return coolest;
  }

  void weigh(HotCandidate& candidate) const {
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
    const double radius = std::max(4.0 * layer_.resolution(), 1.5 * std::sqrt(candidate.spread2));
    candidate.normal =
        normalOf(layer_.within(candidate.centroid, radius), candidate.centroid, kPlaneThickness);
    if (candidate.normal.isZero()) {
      candidate.normal = normalOf(candidate.cells, candidate.centroid, kBulgeThickness);
    }
  }

  /// Zero where the samples show none.
  [[nodiscard]] Eigen::Vector3d normalOf(std::span<const std::uint32_t> samples,
                                         const Eigen::Vector3d& origin, double thickness) const {
    PointSums sums;
    for (const std::uint32_t i : samples) sums.add(layer_[i].p_world - origin);
    if (sums.count < kForNormal) return Eigen::Vector3d::Zero();
    const LocalPlane plane = localPlane(sums, thickness);
    const double least = 0.25 * layer_.resolution() * layer_.resolution();  // a scanner's line has no normal
    if (plane.width2 <= least) return Eigen::Vector3d::Zero();
    return plane.normal.cast<double>();
  }

  /// Takes the weaker clusters that the model explains.
  bool absorb(std::size_t k, HotCandidate& candidate) {
    bool any = false;
    const PeakModel& model = candidate.fit->model;
    for (std::size_t other = k + 1; other < clusters_.size(); ++other) {
      HotCluster& piece = clusters_[other];
      const bool explained = !piece.empty() && std::all_of(piece.begin(), piece.end(), [&](std::uint32_t i) {
        const SurfaceSample& sample = layer_[i];
        const SurfaceBlur blur = blurOfCell(i, candidate, layer_, camera_);
        const double reach = kReach * std::sqrt(model.width * model.width + blur.variance);
        if ((sample.p_world - model.centre).norm() > std::max(reach, 3.0 * layer_.resolution())) return false;
        const double excess = sample.celsius - candidate.reference.celsius;
        return std::abs(sample.celsius - model.at(sample.p_world, blur)) <
               std::max(kExplained * excess, kSure * sample.sigma);
      });
      if (!explained) continue;
      candidate.cells.insert(candidate.cells.end(), piece.begin(), piece.end());
      piece.clear();
      any = true;
    }
    std::sort(candidate.cells.begin(), candidate.cells.end());
    if (any) weigh(candidate);
    return any;
  }

  [[nodiscard]] bool standsOut(const HotCandidate& candidate) const {
    const auto sure = [&](std::uint32_t i) {
      return layer_[i].celsius - candidate.reference.celsius > kSure * layer_[i].sigma;
    };
    return std::any_of(candidate.cells.begin(), candidate.cells.end(), sure);
  }

  /// Whether hardly any surface is known, as of what a single beam has crossed.
  [[nodiscard]] bool hasLinesOnly() const {
    const std::size_t count = layer_.samples().size(), step = std::max<std::size_t>(1, count / kProbes);
    std::size_t probes = 0, known = 0;
    for (std::size_t i = 0; i < count; i += step) {
      ++probes;
      if (!layer_.normal(static_cast<std::uint32_t>(i)).isZero()) ++known;
    }
    return static_cast<double>(known) < kLines * static_cast<double>(probes);
  }

  /// By the criteria, now that its own surroundings are known. On a surface that is known, what is only
  /// warmer than the rest and not large has to have the shape of a peak: a warm wall seen past something cold
  /// is none, nor is the warm image on a floor of something in front that no laser met. What was seen a few
  /// times has to be sure of its shape.
  [[nodiscard]] bool isHot(const HotCandidate& candidate) const {
    if (criteria_.above && candidate.hottest >= *criteria_.above) return true;
    if (!criteria_.delta || candidate.hottest - candidate.reference.celsius < *criteria_.delta) return false;
    const bool knows_surface = std::any_of(candidate.cells.begin(), candidate.cells.end(),
                                           [&](std::uint32_t i) { return !layer_.normal(i).isZero(); });
    const bool is_confirmed = observationsOf(candidate) >= kConfirmed;
    if (!knows_surface && (is_confirmed || has_lines_only_)) return true;
    if (candidate.fit) return isPeak(candidate) || (is_confirmed && peakIsWithin(candidate, layer_));
    return is_confirmed && candidate.reference.same_surface && candidate.cells.size() >= kPatch;
  }

  /// Whether a fit is sure that there is a peak, and that it was seen: not made of the flank of one.
  [[nodiscard]] static bool isPeak(const HotCandidate& candidate) {
    const double seen = candidate.hottest - candidate.reference.celsius;
    return kSurePeak * std::sqrt(candidate.fit->covariance(3, 3)) < 1.0 &&  // sigma of ln rise
           candidate.fit->model.rise < kMostPutBack * seen;
  }

  [[nodiscard]] std::uint64_t observationsOf(const HotCandidate& candidate) const {
    std::uint64_t sum = 0;
    for (const std::uint32_t i : candidate.cells) sum += layer_[i].observations;
    return sum;
  }

  const SurfaceLayer& layer_;
  const HotspotCriteria& criteria_;
  const CameraSight& camera_;
  std::vector<HotCluster> clusters_;
  std::vector<bool> hot_;
  bool has_lines_only_;
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
