#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/hotspot.hpp"
#include "mapping/surface_layer.hpp"

namespace thermovox {

/// How far a temperature stands out, and from what.
struct LocalReference {
  double celsius = 0.0;  ///< median of the surroundings
  double sigma = 0.0;    ///< of that median, C: 1.2533 robust standard deviations over the root of the number
  bool same_surface = false;  ///< whether the surroundings are known to be of the same surface
};

/// Of a set of samples (ascending): the median of those between `gap` and 0.6 m from the nearest of them, on
/// the surface of the warmest one. Where no normal is known, or too few lie on it, all samples at that
/// distance, and of these the upper quartile: better to miss a spot than to compare a rack with the floor.
/// `excluded` samples are of other spots. None where fewer than eight are left.
[[nodiscard]] std::optional<LocalReference> localReference(const SurfaceLayer& layer,
                                                           const std::vector<std::uint32_t>& samples,
                                                           double gap, const std::vector<bool>& excluded);

/// Samples of one hot spot, ascending.
using HotCluster = std::vector<std::uint32_t>;

/// Samples that meet a criterion, joined where they lie within two and a half cells of each other, and parted
/// again where two peaks stand out of the saddle between them: each by more than 35 % of the excess of the
/// lower one over what is not hot, and by three sigmas. In the order of their first samples.
[[nodiscard]] std::vector<HotCluster> hotClusters(const SurfaceLayer& layer, const HotspotCriteria& criteria);

}  // namespace thermovox
