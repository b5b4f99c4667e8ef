#include "io/hotspot_rows.hpp"

#include <algorithm>
#include <utility>

namespace thermovox {
namespace {

std::optional<Estimate> correctedPeak(const HotspotRow& row, const Asset& asset,
                                      const HotspotJudgement& judgement) {
  const std::optional<AssumedSurface> assumed = judgement.assumedSurface(row.ambient);
  if (!asset.emissivity || !assumed) return std::nullopt;
  const Hotspot& spot = *row.spot;
  return withEmissivity({spot.peak.value, spot.peakSigma()}, *assumed, *asset.emissivity);
}

void fillSeverity(const SeverityTable& table, HotspotRow& row) {
  if (const SeverityClass* severity =
          table.classOf(SeverityBasis::over_ambient, judgedPeak(row) - row.ambient)) {
    row.severity = severity->name;
    row.action = severity->action;
  }
  if (const SeverityClass* severity = table.classOf(SeverityBasis::over_similar, row.spot->delta.value)) {
    row.severity_similar = severity->name;
  }
}

void fillSights(const HotspotTrack& track, const StationHotspots& found, HotspotRow& row) {
  row.first_seen = Time::max();
  row.last_seen = Time::min();
  for (std::size_t i = 0; i < track.seen.size(); ++i) {
    if (!track.seen[i]) continue;
    row.missions.push_back(found.missions[i].name);
    row.first_seen = std::min(row.first_seen, track.seen[i]->first_seen);
    row.last_seen = std::max(row.last_seen, track.seen[i]->last_seen);
  }
}

}  // namespace

std::optional<AssumedSurface> HotspotJudgement::assumedSurface(double ambient_celsius) const {
  if (!assumed_emissivity) return std::nullopt;
  return AssumedSurface{.emissivity = *assumed_emissivity, .reflected = ambient_celsius};
}

double judgedPeak(const HotspotRow& row) {
  return row.corrected_peak ? row.corrected_peak->value : row.spot->peak.value;
}

double ambientOf(const StationHotspots& found, std::size_t mission, const std::optional<double>& asked) {
  if (asked) return *asked;
  if (found.missions[mission].ambient) return *found.missions[mission].ambient;
  std::vector<float> temperatures;
  for (const SurfaceSample& sample : found.layers[mission]->samples()) temperatures.push_back(sample.celsius);
  if (temperatures.empty()) return 0.0;
  const auto middle = temperatures.begin() + static_cast<std::ptrdiff_t>(temperatures.size() / 2);
  std::nth_element(temperatures.begin(), middle, temperatures.end());
  return *middle;
}

std::vector<HotspotRow> hotspotRows(const StationHotspots& found, const HotspotJudgement& judgement) {
  std::vector<double> ambients;
  for (std::size_t i = 0; i < found.missions.size(); ++i) {
    ambients.push_back(ambientOf(found, i, judgement.ambient));
  }
  std::vector<HotspotRow> rows;
  for (const HotspotTrack& track : found.history.tracks()) {
    const std::size_t last = track.lastSeen();
    HotspotRow row{.id = track.id, .spot = &*track.seen[last], .change = *track.changes.back()};
    row.ambient = ambients[last];
    if (const auto asset = judgement.assets.of(*row.spot, found.layers[last]->resolution())) {
      row.asset = judgement.assets[*asset].name;
      row.corrected_peak = correctedPeak(row, judgement.assets[*asset], judgement);
    }
    fillSeverity(judgement.table, row);
    fillSights(track, found, row);
    rows.push_back(std::move(row));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const HotspotRow& a, const HotspotRow& b) {
    return a.spot->peak.value > b.spot->peak.value;
  });
  return rows;
}

const HotspotTrack& trackOf(const StationHotspots& found, const HotspotRow& row) {
  const std::vector<HotspotTrack>& tracks = found.history.tracks();
  return *std::find_if(tracks.begin(), tracks.end(),
                       [&](const HotspotTrack& track) { return track.id == row.id; });
}

std::vector<AssetSurvey> surveyMission(const StationHotspots& found, const ThermalMap& scene,
                                       const HotspotJudgement& judgement, std::size_t mission) {
  const double ambient = ambientOf(found, mission, judgement.ambient);
  return surveyAssets(judgement.assets, {.scene = scene,
                                         .layer = *found.layers[mission],
                                         .hotspots = found.history.missions()[mission].hotspots,
                                         .assumed = judgement.assumedSurface(ambient)});
}

int idOf(const StationHotspots& found, std::size_t mission, std::size_t spot) {
  const Eigen::Vector3d& p_world = found.history.missions()[mission].hotspots[spot].position.p_world;
  const std::vector<HotspotTrack>& tracks = found.history.tracks();
  return std::find_if(tracks.begin(), tracks.end(),
                      [&](const HotspotTrack& track) {
                        const std::optional<Hotspot>& seen = track.seen[mission];
                        return seen && seen->position.p_world == p_world;
                      })
      ->id;
}

}  // namespace thermovox
