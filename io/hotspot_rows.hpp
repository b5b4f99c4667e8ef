#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/station_hotspots.hpp"
#include "mapping/asset_emissivity.hpp"
#include "mapping/asset_survey.hpp"
#include "mapping/assets.hpp"
#include "mapping/severity.hpp"

namespace thermovox {

/// How hot spots are judged.
struct HotspotJudgement {
  SeverityTable table = netaSeverity();
  std::optional<double> ambient;  ///< of the air, C; else the mission's, else its layer's median
  Assets assets;
  /// What the missions took all surfaces for, 0.05 to 1. With it, what lies on an asset of another emissivity
  /// is corrected (withEmissivity()); what surfaces mirror counts as being as warm as the air.
  std::optional<double> assumed_emissivity;

  [[nodiscard]] std::optional<AssumedSurface> assumedSurface(double ambient_celsius) const;
};

/// A row of the list: a hot spot as the last mission that saw it has it.
struct HotspotRow {
  int id = 0;
  const Hotspot* spot = nullptr;
  HotspotChange change;  ///< of the last mission of all, against the last one before it that saw it
  double ambient = 0.0;  ///< C, what the severity is counted from
  /// For the emissivity of its asset; none where that or what the mission assumed is not known. The sigma has
  /// the camera's bias in it.
  std::optional<Estimate> corrected_peak;
  std::string severity;  ///< of the rise over ambient (of the corrected peak, if any); empty: there is none
  std::string action;    ///< what to do, in the table's words
  std::string severity_similar;  ///< of the delta over the surroundings; empty where there is none
  std::string asset;             ///< empty where it belongs to none
  Time first_seen;               ///< by any mission
  Time last_seen;
  std::vector<std::string> missions;  ///< that saw it
};

/// The peak that the severity is of, C.
[[nodiscard]] double judgedPeak(const HotspotRow& row);

/// Of all hot spots, the hottest first. `found` has to live on.
[[nodiscard]] std::vector<HotspotRow> hotspotRows(const StationHotspots& found,
                                                  const HotspotJudgement& judgement);

/// What the missions made of a row's hot spot.
[[nodiscard]] const HotspotTrack& trackOf(const StationHotspots& found, const HotspotRow& row);

/// What a mission's rises are counted from, C.
[[nodiscard]] double ambientOf(const StationHotspots& found, std::size_t mission,
                               const std::optional<double>& asked);

/// What a mission found of the assets, in their order; `scene` is the map of all missions.
[[nodiscard]] std::vector<AssetSurvey> surveyMission(const StationHotspots& found, const ThermalMap& scene,
                                                     const HotspotJudgement& judgement, std::size_t mission);
/// The id of a mission's hot spot, by its place among those of the mission.
[[nodiscard]] int idOf(const StationHotspots& found, std::size_t mission, std::size_t spot);

}  // namespace thermovox
