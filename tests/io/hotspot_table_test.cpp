#include "io/hotspot_table.hpp"

#include <nlohmann/json.hpp>

#include "projection/error.hpp"
#include "tests/io/hot_stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::hotMission;
using test::HotPeak;
using test::hotRecord;
using test::TestFolder;
using testing::ElementsAre;
using testing::SizeIs;

const HotPeak kLeft{{0.45, 0.75, 1.02}, 30.0, 0.06}, kRight{{1.05, 0.75, 1.02}, 50.0, 0.06};

std::vector<std::string> keysOf(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

/// Two missions: the right spot is new on the second, the left one stays.
class HotspotTable : public testing::Test {
 protected:
  HotspotTable() {
    Station station = Station::create(folder_ / "plant.tvx", ThermalMap::Options{});
    station.addMission(hotRecord("mon, \"early\"", 0), hotMission({kLeft}, 0), KnownMission::refuse);
    MissionRecord second = hotRecord("tue", 1);
    second.ambient = 15.0;
    station.addMission(second, hotMission({kLeft, kRight}, 1), KnownMission::refuse);
    found_ = stationHotspots(station, {});
  }
  [[nodiscard]] Json json(const HotspotJudgement& judgement = {}) const {
    return Json::parse(hotspotsJson({found_, judgement, hotspotRows(found_, judgement)}));
  }
  /// The fields of a table, by line; quotes taken off as RFC 4180 says.
  [[nodiscard]] std::vector<std::vector<std::string>> csv(const std::vector<HotspotRow>& rows) const {
    writeHotspotsCsv(folder_ / "spots.csv", rows, Existing::replace);
    std::vector<std::vector<std::string>> lines{{""}};
    bool quoted = false;
    const std::string text = test::bytesOf(folder_ / "spots.csv");
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
      if (text[i] == '"' && quoted && text[i + 1] == '"') {
        lines.back().back() += text[++i];
      } else if (text[i] == '"') {
        quoted = !quoted;
      } else if (text[i] == ',' && !quoted) {
        lines.back().emplace_back();
      } else if (text[i] == '\n' && !quoted) {
        lines.push_back({""});
      } else {
        lines.back().back() += text[i];
      }
    }
    EXPECT_EQ(text.back(), '\n');
    return lines;
  }

  TestFolder folder_;
  StationHotspots found_;
};

TEST_F(HotspotTable, HasTheHottestFirstWithItsHistory) {
  const std::vector<HotspotRow> rows = hotspotRows(found_, {});
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_EQ(rows[0].id, 2);
  EXPECT_EQ(rows[1].id, 1);
  EXPECT_EQ(rows[0].change.state, HotspotState::fresh);
  EXPECT_EQ(rows[1].change.state, HotspotState::steady);
  EXPECT_THAT(rows[0].missions, ElementsAre("tue"));
  EXPECT_THAT(rows[1].missions, ElementsAre("mon, \"early\"", "tue"));
  EXPECT_LT(rows[1].first_seen + std::chrono::hours(20), rows[1].last_seen);
  EXPECT_EQ(rows[0].ambient, 15.0);
}

TEST_F(HotspotTable, CountsSeveritiesFromTheAmbient) {
  HotspotJudgement judgement;
  std::vector<HotspotRow> rows = hotspotRows(found_, judgement);
  EXPECT_EQ(rows[0].severity, "major");    // some 70 C over 15 C
  EXPECT_EQ(rows[1].severity, "monitor");  // 50 C over 15 C
  EXPECT_FALSE(rows[0].action.empty());
  judgement.ambient = 45.0;
  rows = hotspotRows(found_, judgement);
  EXPECT_EQ(rows[1].severity, "possible");
  judgement.ambient = 80.0;
  rows = hotspotRows(found_, judgement);
  EXPECT_EQ(rows[0].severity, "");
  EXPECT_EQ(rows[0].action, "");
}

TEST_F(HotspotTable, TakesTheAmbientThatIsAskedThenTheMissionsThenTheMedian) {
  EXPECT_EQ(ambientOf(found_, 1, 30.0), 30.0);
  EXPECT_EQ(ambientOf(found_, 1, std::nullopt), 15.0);
  EXPECT_NEAR(ambientOf(found_, 0, std::nullopt), 20.0, 0.2);
}

TEST_F(HotspotTable, NamesTheAssetThatASpotBelongsTo) {
  Asset asset{.name = "Trafo T1"};
  asset.T_world_box.translation = {1.05, 0.75, 1.0};
  asset.size = {0.3, 0.3, 0.3};
  const std::vector<HotspotRow> rows = hotspotRows(found_, {.assets = Assets({asset})});
  EXPECT_EQ(rows[0].asset, "Trafo T1");
  EXPECT_EQ(rows[1].asset, "");
}

TEST_F(HotspotTable, CorrectsThePeakForTheEmissivityOfItsAsset) {
  Asset bare{.name = "busbar"};
  bare.T_world_box.translation = {0.45, 0.75, 1.0};
  bare.size = {0.3, 0.3, 0.3};
  bare.emissivity = 0.3;
  HotspotJudgement judgement{.ambient = 20.0, .assets = Assets({bare})};
  EXPECT_FALSE(hotspotRows(found_, judgement)[1].corrected_peak) << "nobody says what was assumed";
  judgement.assumed_emissivity = 0.95;
  const std::vector<HotspotRow> rows = hotspotRows(found_, judgement);
  EXPECT_FALSE(rows[0].corrected_peak) << "it lies on no asset";
  const HotspotRow& left = rows[1];
  ASSERT_TRUE(left.corrected_peak);
  const Estimate measured{left.spot->peak.value, left.spot->peakSigma()};
  const auto expected = withEmissivity(measured, {.emissivity = 0.95, .reflected = 20.0}, 0.3);
  EXPECT_EQ(left.corrected_peak->value, expected->value);
  EXPECT_EQ(left.corrected_peak->sigma, expected->sigma);
  EXPECT_GT(left.corrected_peak->value, left.spot->peak.value + 30.0);
  EXPECT_EQ(left.severity, "major") << "of the corrected peak";
  const Json spot = Json::parse(hotspotsJson({found_, judgement, rows}))["hotspots"][1];
  EXPECT_EQ(spot["peak"], left.spot->peak.value) << "as measured";
  EXPECT_EQ(spot["peak_corrected"], expected->value);
}

TEST_F(HotspotTable, ClassifiesTheRiseOverTheSurroundingsToo) {
  HotspotJudgement judgement;
  judgement.table.over_similar = {{35.0, "small", ""}, {1e9, "large", ""}};
  const std::vector<HotspotRow> rows = hotspotRows(found_, judgement);
  EXPECT_EQ(rows[0].severity_similar, "large");
  EXPECT_EQ(rows[1].severity_similar, "small");
}

TEST_F(HotspotTable, JsonHasTheKeysOfTheReadme) {
  const Json spots = json()["hotspots"];
  ASSERT_THAT(spots, SizeIs(2));
  const Json& spot = spots[0];
  EXPECT_THAT(
      keysOf(spot),
      ElementsAre("id", "position", "covariance", "covariance_random", "covariance_common", "peak",
                  "peak_sigma", "bias_sigma", "hottest_cell", "p95", "mean", "reference", "delta",
                  "delta_sigma", "ambient", "area", "extent", "voxels", "observations", "reads_low",
                  "peak_corrected", "peak_corrected_sigma", "severity", "action", "severity_similar", "asset",
                  "state", "alarm", "best_view", "first_seen", "last_seen", "missions", "history"));
  EXPECT_THAT(keysOf(spot["best_view"]), ElementsAre("range", "incidence", "pixels", "frame", "pixel"));
  EXPECT_EQ(spot["id"], 2);
  EXPECT_THAT(spot["position"], SizeIs(3));
  EXPECT_NEAR(spot["position"][0].get<double>(), 1.05, 0.01);
  ASSERT_THAT(spot["covariance"], SizeIs(3));
  ASSERT_THAT(spot["covariance"][2], SizeIs(3));
  EXPECT_NEAR(spot["covariance"][0][1].get<double>(), spot["covariance"][1][0].get<double>(), 1e-15);
  EXPECT_EQ(spot["state"], "new");
  EXPECT_EQ(spot["missions"], Json({"tue"}));
  EXPECT_TRUE(spot["reads_low"].is_boolean());
  EXPECT_TRUE(spot["best_view"]["frame"].is_null());
  // The peak's sigma is the total, the bias of 2 C in it; that of delta is not.
  const Hotspot& hottest = *hotspotRows(found_, {})[0].spot;
  EXPECT_DOUBLE_EQ(spot["peak_sigma"].get<double>(),
                   std::hypot(hottest.peak.sigma, 2.0, hottest.shape_sigma));
  EXPECT_DOUBLE_EQ(spot["delta_sigma"].get<double>(), std::hypot(hottest.delta.sigma, hottest.shape_sigma));
  EXPECT_NEAR(spot["peak"].get<double>() - spot["reference"].get<double>(), spot["delta"].get<double>(),
              1e-9);
  EXPECT_GT(spot["first_seen"].get<double>(), 86'400.0);
}

TEST_F(HotspotTable, JsonTellsTheHistoryAndTheMissions) {
  const Json all = json();
  EXPECT_THAT(keysOf(all), ElementsAre("hotspots", "missions"));
  const Json& left = all["hotspots"][1]["history"];
  ASSERT_THAT(left, SizeIs(2));
  EXPECT_EQ(left[0]["mission"], "mon, \"early\"");
  EXPECT_EQ(left[0]["state"], "new");
  EXPECT_FALSE(left[0]["alarm"]);
  EXPECT_EQ(left[1]["state"], "steady");
  EXPECT_EQ(left[1]["delta"], all["hotspots"][1]["delta"]);
  EXPECT_THAT(all["hotspots"][0]["history"], SizeIs(1)) << "from the first sight on";
  ASSERT_THAT(all["missions"], SizeIs(2));
  EXPECT_EQ(all["missions"][1]["name"], "tue");
  EXPECT_EQ(all["missions"][1]["ambient"], 15.0);
  EXPECT_EQ(all["missions"][1]["cells"], found_.layers[1]->samples().size());
}

TEST_F(HotspotTable, JsonTellsWhatWasFoundOfTheAssets) {
  Asset trafo{.name = "Trafo T1"}, far{.name = "far away"};
  trafo.T_world_box.translation = {1.05, 0.75, 1.0};
  trafo.size = {0.3, 0.3, 0.3};
  far.T_world_box.translation = {50.0, 0.0, 0.0};
  const HotspotJudgement judgement{.assets = Assets({trafo, far})};
  const ThermalMap map = Station::open(folder_ / "plant.tvx").loadMap();
  const Json assets = Json::parse(hotspotsJson({found_, judgement, hotspotRows(found_, judgement),
                                                surveyMission(found_, map, judgement, 1)}))["assets"];
  ASSERT_THAT(assets, SizeIs(2));
  EXPECT_EQ(assets[0]["name"], "Trafo T1");
  EXPECT_EQ(assets[0]["state"], "hot");
  EXPECT_EQ(assets[0]["hotspots"], Json({2}));
  EXPECT_EQ(assets[0]["coverage"], 1.0);
  EXPECT_GT(assets[0]["max"], 60.0);
  EXPECT_EQ(assets[1]["state"], "not_seen");
  EXPECT_TRUE(assets[1]["max"].is_null());
}

TEST_F(HotspotTable, OfNothingIsAnEmptyListAndAHeader) {
  const StationHotspots nothing;
  EXPECT_EQ(Json::parse(hotspotsJson({nothing, HotspotJudgement{}})),
            (Json{{"hotspots", Json::array()}, {"missions", Json::array()}}));
  const auto header = csv({}).at(0);
  EXPECT_THAT(csv({}), SizeIs(1));
  EXPECT_EQ(header, csv(hotspotRows(found_, {})).at(0));
}

TEST_F(HotspotTable, CsvHasTheContentOfTheJson) {
  std::vector<HotspotRow> rows = hotspotRows(found_, {});
  rows[0].asset = "pump \"A\", left\nlower";
  const auto lines = csv(rows);
  ASSERT_THAT(lines, SizeIs(3));
  const Json spots = Json::parse(hotspotsJson({found_, HotspotJudgement{}, rows}))["hotspots"];
  const auto field = [&](std::size_t row, const std::string& name) {
    const auto place = std::find(lines[0].begin(), lines[0].end(), name);
    EXPECT_NE(place, lines[0].end()) << name;
    return lines.at(row + 1).at(static_cast<std::size_t>(place - lines[0].begin()));
  };
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_EQ(lines[row + 1].size(), lines[0].size());
    EXPECT_EQ(std::stod(field(row, "position.0")), spots[row]["position"][0].get<double>());
    EXPECT_EQ(std::stod(field(row, "covariance.2.1")), spots[row]["covariance"][2][1].get<double>());
    EXPECT_EQ(std::stod(field(row, "peak")), spots[row]["peak"].get<double>());
    EXPECT_EQ(field(row, "state"), spots[row]["state"].get<std::string>());
    EXPECT_EQ(field(row, "best_view.pixel.0"), "");
  }
  EXPECT_EQ(field(0, "asset"), "pump \"A\", left\nlower");
  EXPECT_EQ(field(1, "missions"), "mon, \"early\";tue");
}

TEST_F(HotspotTable, CsvHasTheSameColumnsWhetherAFrameIsKnownOrNot) {
  const std::vector<HotspotRow> rows = hotspotRows(found_, {});
  Hotspot framed = *rows[0].spot;
  framed.best_frame = SeenInFrame{Time(std::chrono::milliseconds(1500)), {10.25, 20.5}};
  std::vector<HotspotRow> mixed = rows;
  mixed[0].spot = &framed;
  const auto lines = csv(mixed);
  EXPECT_EQ(lines[0], csv(rows)[0]);
  EXPECT_EQ(lines[1].size(), lines[2].size());
  const auto place = std::find(lines[0].begin(), lines[0].end(), "best_view.pixel.0") - lines[0].begin();
  EXPECT_EQ(lines[1].at(static_cast<std::size_t>(place)), "10.25");
  EXPECT_EQ(lines[2].at(static_cast<std::size_t>(place)), "");
}

TEST_F(HotspotTable, IsNotWrittenOverAFile) {
  folder_.write("spots.csv", "mine");
  EXPECT_THROW(writeHotspotsCsv(folder_ / "spots.csv", hotspotRows(found_, {}), Existing::refuse), DataError);
  EXPECT_EQ(test::bytesOf(folder_ / "spots.csv"), "mine");
}

TEST_F(HotspotTable, DifferencesHaveTheKeysOfTheReadme) {
  const Json difference = Json::parse(differencesJson(found_, 0, 1));
  EXPECT_THAT(keysOf(difference), ElementsAre("from", "to", "hotspots"));
  EXPECT_EQ(difference["from"], "mon, \"early\"");
  ASSERT_THAT(difference["hotspots"], SizeIs(2));
  const Json &steady = difference["hotspots"][0], &fresh = difference["hotspots"][1];
  EXPECT_THAT(keysOf(fresh), ElementsAre("id", "state", "position", "delta_from", "delta_to", "change",
                                         "sigma", "significance", "alarm"));
  EXPECT_EQ(steady["state"], "steady");
  EXPECT_EQ(steady["alarm"], false);
  EXPECT_EQ(fresh["state"], "new");
  EXPECT_EQ(fresh["alarm"], true);
  EXPECT_NEAR(fresh["change"].get<double>(), 50.0, 5.0);
  EXPECT_GT(fresh["significance"].get<double>(), 3.0);
}

TEST_F(HotspotTable, DifferencesWithWhatNobodySawAreNull) {
  const fs::path path = folder_ / "plant.tvx";
  Station::open(path).addMission(
      hotRecord("wed", 2),
      test::mapOf(test::returnsOf({.length = 0.2}, [](const Eigen::Vector3d&) { return 20.0; })),
      KnownMission::refuse);
  const StationHotspots found = stationHotspots(Station::open(path), {});
  const Json spots = Json::parse(differencesJson(found, 1, 2))["hotspots"];
  ASSERT_THAT(spots, SizeIs(2));
  for (const Json& spot : spots) {
    EXPECT_EQ(spot["state"], "not_observed");
    for (const char* key : {"delta_to", "change", "sigma", "significance"}) EXPECT_TRUE(spot[key].is_null());
    EXPECT_FALSE(spot["alarm"]);
  }
}

TEST_F(HotspotTable, IsTheSameTextEveryTime) {
  const StationHotspots again = stationHotspots(Station::open(folder_ / "plant.tvx"), {});
  const HotspotJudgement judgement;
  EXPECT_EQ(hotspotsJson({found_, judgement, hotspotRows(found_, judgement)}),
            hotspotsJson({again, judgement, hotspotRows(again, judgement)}));
}

}  // namespace
}  // namespace thermovox
