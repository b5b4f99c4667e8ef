#include "mapping/asset_survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapping/percentile.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// One survey at work.
class Survey {
 public:
  Survey(const Assets& assets, const AssetInspection& inspection)
      : assets_(assets), inspection_(inspection), surveys_(assets.size()), celsius_(assets.size()) {
    countSurface();
    takeTemperatures();
    takeHotspots();
  }

  std::vector<AssetSurvey> run() && {
    for (std::size_t i = 0; i < surveys_.size(); ++i) summarize(i);
    for (std::size_t i = 0; i < surveys_.size(); ++i) compareWithTwins(i);
    for (std::size_t i = 0; i < surveys_.size(); ++i) judge(i);
    return std::move(surveys_);
  }

 private:
  void countSurface() {
    CellAssets cells(assets_, inspection_.scene.resolution());
    forEachSurface(inspection_.scene, [&](const CellKey& key, const SurfaceCell&) {
      if (const std::optional<std::size_t> asset = cells.at(key)) ++surveys_[*asset].surface_cells;
    });
  }

  void takeTemperatures() {
    CellAssets cells(assets_, inspection_.layer.resolution());
    for (const SurfaceSample& sample : inspection_.layer.samples()) {
      const std::optional<std::size_t> asset = cells.at(sample.key);
      if (!asset) continue;
      if (const std::optional<Estimate> celsius = temperatureOf(sample, assets_[*asset])) {
        take(*asset, *celsius, sample.p_world);
      }
    }
  }

  [[nodiscard]] bool corrects(const Asset& asset) const { return inspection_.assumed && asset.emissivity; }

  [[nodiscard]] std::optional<Estimate> temperatureOf(const SurfaceSample& sample, const Asset& asset) const {
    const Estimate celsius{sample.celsius, sample.sigma};
    if (!corrects(asset)) return celsius;
    return withEmissivity(celsius, *inspection_.assumed, *asset.emissivity);
  }

  void take(std::size_t asset, const Estimate& celsius, const Eigen::Vector3d& p_world) {
    AssetSurvey& survey = surveys_[asset];
    ++survey.coloured_cells;
    celsius_[asset].push_back(celsius.value);
    if (!survey.temperatures || celsius.value > survey.temperatures->hottest.value) {
      survey.temperatures = AssetTemperatures{.hottest = celsius, .hottest_at = p_world};
    }
    const std::optional<double>& above = assets_[asset].limits.above;
    if (above && celsius.value - celsius.sigma > *above) survey.over_above = true;
  }

  void takeHotspots() {
    for (std::size_t k = 0; k < inspection_.hotspots.size(); ++k) {
      const Hotspot& spot = inspection_.hotspots[k];
      const std::optional<std::size_t> asset = assets_.of(spot, inspection_.layer.resolution());
      if (!asset) continue;
      surveys_[*asset].hotspots.push_back(k);
      const std::optional<double>& delta = assets_[*asset].limits.delta;
      if (delta && spot.delta.value > *delta) surveys_[*asset].over_delta = true;
    }
  }

  void summarize(std::size_t asset) {
    std::optional<AssetTemperatures>& temperatures = surveys_[asset].temperatures;
    if (!temperatures) return;
    const std::vector<double>& celsius = celsius_[asset];
    temperatures->p95 = percentile(celsius, 0.95);
    for (const double c : celsius) temperatures->mean += c / static_cast<double>(celsius.size());
    temperatures->corrected = corrects(assets_[asset]);
  }

  [[nodiscard]] bool isInspected(const AssetSurvey& survey) const {
    return survey.temperatures && survey.coverage() >= inspection_.inspected_share;
  }

  void compareWithTwins(std::size_t asset) {
    AssetSurvey& survey = surveys_[asset];
    if (!survey.temperatures) return;
    std::vector<double> p95, hottest;
    for (const std::size_t twin : assets_.twinsOf(asset)) {
      if (!isInspected(surveys_[twin])) continue;
      p95.push_back(surveys_[twin].temperatures->p95);
      hottest.push_back(surveys_[twin].temperatures->hottest.value);
    }
    if (p95.empty()) return;
    survey.over_twins =
        TwinDifference{survey.temperatures->p95 - percentile(p95, 0.5),
                       survey.temperatures->hottest.value - percentile(hottest, 0.5), p95.size()};
    const std::optional<double>& delta = assets_[asset].limits.delta;
    if (delta && survey.over_twins->p95 > *delta) survey.over_delta = true;
  }

  void judge(std::size_t asset) {
    AssetSurvey& survey = surveys_[asset];
    if (!survey.hotspots.empty() || survey.over_above || survey.over_delta) {
      survey.state = AssetState::hot;
    } else if (!survey.temperatures) {
      survey.state = AssetState::not_seen;
    } else {
      survey.state = isInspected(survey) ? AssetState::nothing_found : AssetState::partly_seen;
    }
  }

  const Assets& assets_;
  const AssetInspection& inspection_;
  std::vector<AssetSurvey> surveys_;
  std::vector<std::vector<double>> celsius_;  ///< by asset
};

}  // namespace

const char* nameOf(AssetState state) {
  switch (state) {
    case AssetState::not_seen:
      return "not_seen";
    case AssetState::partly_seen:
      return "partly_seen";
    case AssetState::nothing_found:
      return "nothing_found";
    case AssetState::hot:
      return "hot";
  }
  return "";
}

double AssetSurvey::coverage() const {
  if (surface_cells == 0) return 0.0;
  return static_cast<double>(coloured_cells) / static_cast<double>(surface_cells);
}

std::vector<AssetSurvey> surveyAssets(const Assets& assets, const AssetInspection& inspection) {
  if (inspection.scene.resolution() != inspection.layer.resolution()) {
    throw ConfigError("assets: the mission has cells of " + std::to_string(inspection.layer.resolution()) +
                      " m, expected " + std::to_string(inspection.scene.resolution()) + " m as in the scene");
  }
  return Survey(assets, inspection).run();
}

}  // namespace thermovox
