#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapping/asset_emissivity.hpp"
#include "mapping/assets.hpp"
#include "mapping/surface_layer.hpp"

namespace thermovox {

/// What a mission can say of an asset.
enum class AssetState {
  not_seen,       ///< no temperature of any of it
  partly_seen,    ///< nothing found, but too little of it was seen to say that there is nothing
  nothing_found,  ///< inspected, nothing found
  hot,            ///< a hot spot is in it, or it is over one of its limits
};
/// The word of the reports: "not_seen", "partly_seen", "nothing_found", "hot".
[[nodiscard]] const char* nameOf(AssetState state);

/// The temperatures of an asset.
struct AssetTemperatures {
  Estimate hottest;                                      ///< C, of the hottest cell
  Eigen::Vector3d hottest_at = Eigen::Vector3d::Zero();  ///< metres, world
  double p95 = 0.0;                                      ///< C, 95th percentile of its cells
  double mean = 0.0;                                     ///< C, of its cells
  bool corrected = false;  ///< for its own emissivity; false: as the map holds them
};

/// How much hotter an asset is than its twins: than the median of those that were inspected.
struct TwinDifference {
  double p95 = 0.0;      ///< between the 95th percentiles, C: the one to trust, as it is of many cells
  double hottest = 0.0;  ///< between the hottest cells, C
  std::size_t twins = 0;
};

/// What a mission found of one asset. Its cells are those that belong to it and to no smaller asset within
/// it.
struct AssetSurvey {
  std::size_t surface_cells = 0;      ///< that the scene has
  std::size_t coloured_cells = 0;     ///< of these, with a temperature from the mission
  std::vector<std::size_t> hotspots;  ///< indices
  std::optional<AssetTemperatures> temperatures;
  std::optional<TwinDifference> over_twins;  ///< none without temperatures, or where no twin was inspected
  bool over_above = false;                   ///< a cell is over limits.above by more than its sigma
  bool over_delta = false;  ///< a hot spot's delta, or the p95 over the twins', is over limits.delta
  AssetState state = AssetState::not_seen;

  /// Share of the asset's surface that the mission has temperatures of, 0 to 1; 0 without surface.
  [[nodiscard]] double coverage() const;
};

/// A mission to be asked about assets.
struct AssetInspection {
  const ThermalMap& scene;            ///< all surface that is known, the mission's own included
  const SurfaceLayer& layer;          ///< the mission's temperatures, in cells of the same size
  std::span<const Hotspot> hotspots;  ///< of the mission
  /// What the mission took its surfaces for. With it, an asset that knows its emissivity gets its
  /// temperatures corrected (withEmissivity()); without, and in the hot spots, they stay as the map holds
  /// them. A cell that cannot be corrected counts as not seen.
  std::optional<AssumedSurface> assumed;
  /// Coverage from which an asset counts as inspected. Half, as of a hot spot's cells before it counts as
  /// gone; reports name the coverage beside the answer.
  double inspected_share = 0.5;
};

/// One survey for each asset, in their order. Throws ConfigError when the layer's cells are of another size
/// than the scene's.
[[nodiscard]] std::vector<AssetSurvey> surveyAssets(const Assets& assets, const AssetInspection& inspection);

}  // namespace thermovox
