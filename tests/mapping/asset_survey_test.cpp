#include "mapping/asset_survey.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kEdge = 0.1;

/// Four boxes of one metre side by side along x, a floor of 10 x 10 cells in each, and how warm its cells
/// are.
class AssetSurveys : public testing::Test {
 protected:
  using Celsius = std::function<std::optional<double>(int asset, int cell)>;

  static std::vector<Asset> boxes() {
    std::vector<Asset> assets;
    for (const char* name : {"A", "B", "C", "D"}) {
      Asset asset{.name = name};
      asset.T_world_box.translation = {static_cast<double>(assets.size()) + 0.5, 0.5, 0.0};
      assets.push_back(asset);
    }
    return assets;
  }

  static ThermalMap map(const Celsius& celsius) {
    ThermalMap map({.resolution = kEdge});
    std::vector<MappedReturn> reading;
    for (int asset = 0; asset < 4; ++asset) {
      for (int cell = 0; cell < 100; ++cell) {
        const Eigen::Vector3d p(asset + (cell % 10 + 0.5) * kEdge, (cell / 10 + 0.5) * kEdge, 0.05);
        MappedReturn point{p, Eigen::Vector3d(2.0, 0.5, 3.0), Time(std::chrono::seconds(5)), std::nullopt};
        if (const std::optional<double> c = celsius(asset, cell)) {
          point.temperature = TemperatureObservation{static_cast<float>(*c), 0.5F, 3.0F, 0.1F};
        }
        reading.push_back(point);
      }
    }
    map.integrate(reading, Carving::none);
    return map;
  }

  static std::vector<AssetSurvey> survey(const std::vector<Asset>& assets, const Celsius& celsius,
                                         std::span<const Hotspot> hotspots = {},
                                         std::optional<AssumedSurface> assumed = {}) {
    const ThermalMap scene = map(celsius);
    const SurfaceLayer layer(scene);
    return surveyAssets(Assets(assets),
                        {.scene = scene, .layer = layer, .hotspots = hotspots, .assumed = assumed});
  }

  static Hotspot spotAt(const Eigen::Vector3d& p_world, double delta) {
    Hotspot spot;
    spot.position.p_world = p_world;
    spot.delta = {delta, 0.3};
    return spot;
  }
};

TEST_F(AssetSurveys, NothingFoundIsNotNotSeen) {
  const std::vector<Hotspot> spots{spotAt({3.5, 0.5, 0.05}, 12.0)};
  const auto found = survey(
      boxes(),
      [](int asset, int cell) -> std::optional<double> {
        const int seen[] = {50, 49, 0, 10};
        return cell < seen[asset] ? std::optional(21.0) : std::nullopt;
      },
      spots);
  EXPECT_EQ(found[0].state, AssetState::nothing_found);
  EXPECT_EQ(found[0].coverage(), 0.5);
  EXPECT_EQ(found[1].state, AssetState::partly_seen);
  EXPECT_EQ(found[2].state, AssetState::not_seen);
  EXPECT_EQ(found[2].surface_cells, 100U);
  EXPECT_FALSE(found[2].temperatures);
  EXPECT_EQ(found[3].state, AssetState::hot);
  EXPECT_THAT(found[3].hotspots, testing::ElementsAre(0U));
  EXPECT_STREQ(nameOf(found[0].state), "nothing_found");
}

TEST_F(AssetSurveys, AnAssetWithoutAnySurfaceIsNotSeen) {
  std::vector<Asset> assets = boxes();
  assets[0].T_world_box.translation.z() = 50.0;
  const auto found = survey(assets, [](int, int) { return 21.0; });
  EXPECT_EQ(found[0].state, AssetState::not_seen);
  EXPECT_EQ(found[0].coverage(), 0.0);
}

TEST_F(AssetSurveys, TemperaturesAreThoseOfTheCells) {
  const auto found = survey(boxes(), [](int asset, int cell) { return 20.0 + 10.0 * asset + 0.1 * cell; });
  const AssetTemperatures& b = *found[1].temperatures;
  EXPECT_NEAR(b.hottest.value, 39.9, 0.01);
  EXPECT_NEAR(b.hottest.sigma, 0.5, 0.01);
  EXPECT_NEAR((b.hottest_at - Eigen::Vector3d(1.95, 0.95, 0.05)).norm(), 0.0, 1e-3);
  EXPECT_NEAR(b.mean, 34.95, 0.01);
  EXPECT_NEAR(b.p95, 30.0 + 0.1 * 0.95 * 99, 0.01);
  EXPECT_FALSE(b.corrected);
}

TEST_F(AssetSurveys, TwinsAreComparedWithTheMedianOfThoseThatWereInspected) {
  std::vector<Asset> assets = boxes();
  for (Asset& asset : assets) asset.twin_group = "phases";
  const auto found = survey(assets, [](int asset, int cell) -> std::optional<double> {
    const double celsius[] = {30.0, 32.0, 45.0, 99.0};
    return asset == 3 && cell > 5 ? std::nullopt : std::optional(celsius[asset]);  // D: hardly seen
  });
  ASSERT_TRUE(found[2].over_twins);
  EXPECT_EQ(found[2].over_twins->twins, 2U);
  EXPECT_NEAR(found[2].over_twins->p95, 45.0 - 31.0, 0.01);
  EXPECT_NEAR(found[2].over_twins->hottest, 45.0 - 31.0, 0.01);
  EXPECT_NEAR(found[0].over_twins->p95, 30.0 - 38.5, 0.01);
  EXPECT_NEAR(found[3].over_twins->p95, 99.0 - 32.0, 0.01);  // compared itself, but with nobody else
  const auto alone = survey(assets, [](int asset, int) -> std::optional<double> {
    return asset == 0 ? std::optional(30.0) : std::nullopt;
  });
  EXPECT_FALSE(alone[0].over_twins);
}

TEST_F(AssetSurveys, LimitsAreTheAssetsOwn) {
  std::vector<Asset> assets = boxes();
  assets[0].limits.above = 60.0;
  assets[1].limits.above = 60.0;
  assets[2].limits.delta = 5.0;
  assets[3].limits.delta = 5.0;
  assets[2].twin_group = assets[3].twin_group = "pair";
  const auto celsius = [](int asset, int cell) {
    if (asset == 0 && cell == 7) return 60.7;  // by more than its sigma
    if (asset == 1 && cell == 7) return 60.3;
    return asset == 2 ? 36.0 : 30.0;
  };
  const auto found = survey(assets, celsius);
  EXPECT_TRUE(found[0].over_above);
  EXPECT_EQ(found[0].state, AssetState::hot);
  EXPECT_FALSE(found[1].over_above);
  EXPECT_EQ(found[1].state, AssetState::nothing_found);
  EXPECT_TRUE(found[2].over_delta);
  EXPECT_FALSE(found[3].over_delta);
  const std::vector<Hotspot> spots{spotAt({3.5, 0.5, 0.05}, 5.5)};
  EXPECT_TRUE(survey(assets, celsius, spots)[3].over_delta);
}

TEST_F(AssetSurveys, AnEmissivityIsAppliedWhereTheMissionsIsKnown) {
  std::vector<Asset> assets = boxes();
  assets[1].emissivity = 0.5;
  assets[1].limits.above = 60.0;
  const auto celsius = [](int, int) { return 50.0; };
  const AssumedSurface assumed{.emissivity = 0.95, .reflected = 20.0};
  const auto found = survey(assets, celsius, {}, assumed);
  const Estimate expected = *withEmissivity({50.0, 0.5}, assumed, 0.5);
  EXPECT_TRUE(found[1].temperatures->corrected);
  EXPECT_NEAR(found[1].temperatures->hottest.value, expected.value, 0.01);
  EXPECT_NEAR(found[1].temperatures->hottest.sigma, expected.sigma, 0.01);
  EXPECT_TRUE(found[1].over_above);
  EXPECT_FALSE(found[0].temperatures->corrected);
  EXPECT_NEAR(found[0].temperatures->mean, 50.0, 0.01);
  EXPECT_NEAR(survey(assets, celsius)[1].temperatures->mean, 50.0, 0.01);
}

TEST_F(AssetSurveys, CoverageCountsTheSurfaceThatOtherMissionsKnow) {
  const ThermalMap scene = map([](int, int) { return 20.0; });
  const ThermalMap mission({.resolution = kEdge});
  const SurfaceLayer layer(mission);
  const Assets assets(boxes());
  const auto found = surveyAssets(assets, {.scene = scene, .layer = layer, .hotspots = {}});
  EXPECT_EQ(found[0].state, AssetState::not_seen);
  EXPECT_EQ(found[0].surface_cells, 100U);
  const SurfaceLayer coarse(ThermalMap({.resolution = 0.2}));
  const AssetInspection wrong{.scene = scene, .layer = coarse, .hotspots = {}};
  EXPECT_THROW(static_cast<void>(surveyAssets(assets, wrong)), ConfigError);
}

}  // namespace
}  // namespace thermovox
