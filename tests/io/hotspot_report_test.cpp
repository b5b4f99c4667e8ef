#include "io/hotspot_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "projection/error.hpp"
#include "tests/io/html_checks.hpp"
#include "tests/io/reported_plant.hpp"

namespace thermovox {
namespace {

using test::countOf;
using test::expectSound;
using test::ReportedPlant;
using testing::HasSubstr;
using testing::Not;

std::vector<ReportedPlant::Rise> rises(std::size_t count, double first = 30.0) {
  std::vector<ReportedPlant::Rise> all;
  for (std::size_t i = 0; i < count; ++i) all.emplace_back(first + static_cast<double>(i));
  return all;
}

TEST(HotspotReport, EverySpotHasItsMarkItsRowAndItsPage) {
  ReportedPlant plant;
  plant.fly("monday", rises(50));
  const std::string html = hotspotReportHtml(plant.report());
  expectSound(html);
  ASSERT_EQ(plant.found().history.tracks().size(), 50U);
  EXPECT_EQ(countOf(html, "<section class=\"spot\" id=\"spot-"), 50U);
  EXPECT_EQ(countOf(html, "id=\"row-"), 50U);
  for (int id = 1; id <= 50; ++id) {  // three maps, the list
    EXPECT_GE(countOf(html, "href=\"#spot-" + std::to_string(id) + "\""), 4U) << id;
  }
  EXPECT_THAT(html, HasSubstr("<b>50 hot spots</b>"));
  EXPECT_THAT(html, HasSubstr("ANSI/NETA MTS, table 100.18, edition 2019"));
}

TEST(HotspotReport, TheSameInputGivesTheSameBytes) {
  ReportedPlant one, other;
  for (ReportedPlant* plant : {&one, &other}) plant->fly("monday", rises(3));
  EXPECT_EQ(hotspotReportHtml(one.report()), hotspotReportHtml(other.report()));
}

TEST(HotspotReport, WhereNothingIsFoundItSaysSoWithTheCoverage) {
  ReportedPlant plant;
  plant.fly("monday", {std::nullopt, 0.0});
  const std::string html = hotspotReportHtml(plant.report());
  expectSound(html);
  EXPECT_THAT(html, HasSubstr("<b>No hot spot was found</b>"));
  EXPECT_THAT(html, HasSubstr("of the 19&#8239;200 cells that hold a surface have a temperature (99 %)"));
  EXPECT_THAT(html, Not(HasSubstr("id=\"spot-")));
}

TEST(HotspotReport, TheHistoryTellsGoneFromNotObserved) {
  ReportedPlant plant;
  plant.fly("monday", {30.0, 30.0, 30.0});
  plant.fly("tuesday", {30.0, 0.0, std::nullopt});
  plant.fly("wednesday", {45.0, 0.0, 30.0});
  const std::string html = hotspotReportHtml(plant.report());
  expectSound(html);
  EXPECT_THAT(html, HasSubstr("<b>growing</b>"));
  EXPECT_THAT(html, HasSubstr(">gone<"));
  EXPECT_THAT(html, HasSubstr(">not observed</text>"));  // the gap in the plot
  EXPECT_THAT(html, HasSubstr("new or growing: <b>1</b>"));
}

TEST(HotspotReport, NoTextFromOutsideBecomesMarkup) {
  ReportedPlant plant;
  const std::string evil = "<script>alert(1)</script>\"'&";
  plant.fly(evil, {30.0});
  plant.fly("\xFF\x01 bytes", {30.0});
  Asset asset{.name = "<img src=x onerror=alert(1)>"};
  asset.T_world_box.translation = ReportedPlant::placeOf(0);
  HotspotJudgement judgement{.assets = Assets({asset})};
  for (SeverityClass& entry : judgement.table.over_ambient) entry.action = "</td><b onclick=\"x\">";
  HotspotReport report = plant.report(judgement);
  report.title = "</title><script>";
  report.station = "<i>.tvx";
  const std::string html = hotspotReportHtml(report);
  expectSound(html);
  for (const char* tag : {"<script", "<img", "<b onclick", "<i>"})
    EXPECT_THAT(html, Not(HasSubstr(tag))) << tag;
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;"));
  EXPECT_THAT(html, HasSubstr("?? bytes"));
}

TEST(HotspotReport, NothingFoundAndNotSeenAreDifferentAnswersAboutAnAsset) {
  ReportedPlant plant;
  plant.fly("monday", {30.0, 0.0, std::nullopt});
  std::vector<Asset> assets;
  for (const char* name : {"hot pump", "sound pump", "hidden pump", "far pump"}) {
    Asset asset{.name = name, .size = Eigen::Vector3d::Constant(0.4)};
    asset.T_world_box.translation = ReportedPlant::placeOf(assets.size());
    assets.push_back(asset);
  }
  assets.back().T_world_box.translation.z() = 50.0;
  const std::string html = hotspotReportHtml(plant.report({.assets = Assets(assets)}));
  expectSound(html);
  const auto rowOf = [&](const std::string& name) {
    const std::size_t at = html.find("<bdi>" + name, html.find("id=\"assets\""));
    return html.substr(at, html.find("</tr>", at) - at);
  };
  EXPECT_THAT(rowOf("hot pump"), HasSubstr("href=\"#spot-1\""));
  EXPECT_THAT(rowOf("sound pump"), HasSubstr("inspected, nothing found"));
  EXPECT_THAT(rowOf("hidden pump"), HasSubstr("not seen"));
  EXPECT_THAT(rowOf("far pump"), HasSubstr("no surface"));
  const std::string missing = html.substr(html.find("Assets not inspected: not seen"));
  EXPECT_THAT(missing, HasSubstr("hidden pump"));
  EXPECT_THAT(missing, Not(HasSubstr("sound pump")));
}

TEST(HotspotReport, RefusesAMapWithoutSurface) {
  const StationHotspots found;
  const ThermalMap map({.resolution = 0.1});
  const HotspotReport report{.title = "",
                             .station = "empty.tvx",
                             .version = "",
                             .criteria = {},
                             .judgement = {},
                             .found = found,
                             .map = map};
  EXPECT_THROW((void)hotspotReportHtml(report), DataError);
}

}  // namespace
}  // namespace thermovox
