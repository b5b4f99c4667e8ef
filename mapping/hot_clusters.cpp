#include "mapping/hot_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace thermovox {
namespace {

constexpr double kSurroundings = 0.6;  // metres
constexpr double kCellGap = 0.25;      // metres that a hot spot may reach from a cell of its own
constexpr std::size_t kFewest = 8;     // samples of the surroundings
constexpr double kLink = 2.5;          // cells
constexpr double kParting = 0.35;      // of the lower peak's excess
constexpr double kSure = 3.0;          // sigmas by which a cell has to stand out

double quantile(std::vector<double>& values, double q) {
  const auto place = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

LocalReference referenceOf(std::vector<double>& temperatures, double q) {
  const double centre = quantile(temperatures, q);
  std::vector<double> deviations(temperatures.size());
  std::transform(temperatures.begin(), temperatures.end(), deviations.begin(),
                 [centre](double t) { return std::abs(t - centre); });
  const double spread = 1.4826 * quantile(deviations, 0.5);
  return {centre, 1.2533 * spread / std::sqrt(static_cast<double>(temperatures.size()))};
}

/// Samples within a radius of any of these, ascending.
std::vector<std::uint32_t> within(const SurfaceLayer& layer, const std::vector<std::uint32_t>& samples,
                                  double radius) {
  if (samples.size() == 1) return layer.within(layer[samples.front()].p_world, radius);
  std::vector<bool> is_near(layer.samples().size());
  std::vector<std::uint32_t> near;
  for (const std::uint32_t i : samples) {
    for (const std::uint32_t j : layer.within(layer[i].p_world, radius)) {
      if (!is_near[j]) near.push_back(j);
      is_near[j] = true;
    }
  }
  std::sort(near.begin(), near.end());
  return near;
}

/// The lowest temperature anywhere near, by cubes as wide as the surroundings: no median is lower.
class LowestNear {
 public:
  explicit LowestNear(const SurfaceLayer& layer) {
    for (const SurfaceSample& sample : layer.samples()) {
      const auto [place, is_new] = lowest_.try_emplace(cubeOf(sample.p_world), sample.celsius);
      if (!is_new) place->second = std::min(place->second, sample.celsius);
    }
  }
  [[nodiscard]] float at(const Eigen::Vector3d& p) const {
    float lowest = std::numeric_limits<float>::infinity();
    const BlockKey centre = cubeOf(p);
    for (int i = 0; i < 27; ++i) {
      const BlockKey cube{centre.x + i % 3 - 1, centre.y + i / 3 % 3 - 1, centre.z + i / 9 - 1};
      if (const auto found = lowest_.find(cube); found != lowest_.end()) {
        lowest = std::min(lowest, found->second);
      }
    }
    return lowest;
  }

 private:
  static BlockKey cubeOf(const Eigen::Vector3d& p) {
    const Eigen::Vector3d cube = (p / kSurroundings).array().floor();
    return {static_cast<std::int32_t>(cube.x()), static_cast<std::int32_t>(cube.y()),
            static_cast<std::int32_t>(cube.z())};
  }
  std::unordered_map<BlockKey, float, BlockKeyHash> lowest_;
};

std::vector<std::uint32_t> hotSamples(const SurfaceLayer& layer, const HotspotCriteria& criteria) {
  const LowestNear lowest(layer);
  const std::vector<bool> none(layer.samples().size());
  std::vector<std::uint32_t> hot;
  for (std::uint32_t i = 0; i < layer.samples().size(); ++i) {
    const SurfaceSample& sample = layer[i];
    bool is_hot = criteria.above && sample.celsius >= *criteria.above;
    if (!is_hot && criteria.delta && sample.celsius - lowest.at(sample.p_world) >= *criteria.delta) {
      const std::optional<LocalReference> reference = localReference(layer, {i}, kCellGap, none);
      is_hot = reference && sample.celsius - reference->celsius >=
                                std::max(*criteria.delta, kSure * static_cast<double>(sample.sigma));
    }
    if (is_hot) hot.push_back(i);
  }
  return hot;
}

/// Samples taken from the hottest on; one joins the basin of a hotter neighbour, and joins basins where their
/// peaks do not stand out of it (persistence, as in Edelsbrunner, Letscher and Zomorodian 2002), or only as
/// much as noise does.
class Basins {
 public:
  Basins(const SurfaceLayer& layer, const std::vector<std::uint32_t>& hot, double floor)
      : layer_(layer), hot_(hot), floor_(floor), basin_(hot.size(), kNone) {}

  std::vector<HotCluster> fill() {
    std::vector<std::size_t> order(hot_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return layer_[hot_[a]].celsius > layer_[hot_[b]].celsius;
    });
    for (const std::size_t i : order) add(i);
    std::vector<HotCluster> of_basin(hot_.size());
    for (std::size_t i = 0; i < hot_.size(); ++i) of_basin[rootOf(i)].push_back(hot_[i]);
    std::erase_if(of_basin, [](const HotCluster& cluster) { return cluster.empty(); });
    std::sort(of_basin.begin(), of_basin.end());
    return of_basin;
  }

 private:
  static constexpr std::size_t kNone = SIZE_MAX;

  [[nodiscard]] std::size_t rootOf(std::size_t i) {
    while (basin_[i] != i) i = basin_[i] = basin_[basin_[i]];
    return i;
  }

  void add(std::size_t i) {
    const double celsius = layer_[hot_[i]].celsius;
    std::vector<std::size_t> near;  // roots of the neighbours' basins, that of the hottest peak first
    for (const std::uint32_t j : layer_.within(layer_[hot_[i]].p_world, kLink * layer_.resolution())) {
      const auto place = std::lower_bound(hot_.begin(), hot_.end(), j);
      if (place == hot_.end() || *place != j) continue;
      const auto k = static_cast<std::size_t>(place - hot_.begin());
      if (basin_[k] != kNone) near.push_back(rootOf(k));
    }
    std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
      const float hotter = layer_[hot_[a]].celsius, other = layer_[hot_[b]].celsius;
      return hotter != other ? hotter > other : a < b;
    });
    near.erase(std::unique(near.begin(), near.end()), near.end());
    basin_[i] = near.empty() ? i : near.front();
    for (std::size_t n = 1; n < near.size(); ++n) {  // the lower peak of the two decides
      const SurfaceSample& peak = layer_[hot_[near[n]]];
      const double noise = std::hypot(peak.sigma, layer_[hot_[i]].sigma);
      const double least = std::max(kParting * (peak.celsius - floor_), kSure * noise);
      if (peak.celsius - celsius < least) basin_[near[n]] = near.front();
    }
  }

  const SurfaceLayer& layer_;
  const std::vector<std::uint32_t>& hot_;
  double floor_;
  std::vector<std::size_t> basin_;
};

/// What peaks are parted over, C: the median of what is not hot, or the lowest where all is.
double floorOf(const SurfaceLayer& layer, const std::vector<std::uint32_t>& hot) {
  std::vector<double> cool;
  double lowest = layer[0].celsius;
  for (std::uint32_t i = 0; i < layer.samples().size(); ++i) {
    lowest = std::min<double>(lowest, layer[i].celsius);
    if (!std::binary_search(hot.begin(), hot.end(), i)) cool.push_back(layer[i].celsius);
  }
  return cool.empty() ? lowest : quantile(cool, 0.5);
}

}  // namespace

std::optional<LocalReference> localReference(const SurfaceLayer& layer,
                                             const std::vector<std::uint32_t>& samples, double gap,
                                             const std::vector<bool>& excluded) {
  const std::uint32_t warmest = *std::max_element(
      samples.begin(), samples.end(),
      [&](std::uint32_t a, std::uint32_t b) { return layer[a].celsius < layer[b].celsius; });
  const std::vector<std::uint32_t> near = within(layer, samples, kSurroundings);
  std::vector<double> on_surface, all;
  const std::vector<std::uint32_t> too_near = within(layer, samples, gap);
  for (const std::uint32_t j : near) {
    if (excluded[j] || std::binary_search(too_near.begin(), too_near.end(), j)) continue;
    all.push_back(layer[j].celsius);
    if (layer.onSameSurface(warmest, j)) on_surface.push_back(layer[j].celsius);
  }
  if (on_surface.size() >= kFewest) {
    LocalReference reference = referenceOf(on_surface, 0.5);
    reference.same_surface = true;
    return reference;
  }
  if (all.size() >= kFewest) return referenceOf(all, 0.75);
  return std::nullopt;
}

std::vector<HotCluster> hotClusters(const SurfaceLayer& layer, const HotspotCriteria& criteria) {
  const std::vector<std::uint32_t> hot = hotSamples(layer, criteria);
  if (hot.empty()) return {};
  return Basins(layer, hot, floorOf(layer, hot)).fill();
}

}  // namespace thermovox
