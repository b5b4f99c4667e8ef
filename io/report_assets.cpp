// What was found of each asset, and what was not inspected.

#include <fmt/format.h>

#include "io/report_html.hpp"
#include "io/report_sections.hpp"
#include "mapping/asset_survey.hpp"

namespace thermovox {
namespace {

using Surveys = std::vector<std::vector<AssetSurvey>>;  // by mission, then asset

Surveys surveysOf(const ReportContents& contents) {
  Surveys surveys;
  const StationHotspots& found = contents.report.found;
  for (std::size_t i = 0; i < contents.missions().size(); ++i) {
    surveys.push_back(surveyMission(found, contents.report.map, contents.report.judgement, i));
  }
  return surveys;
}

bool isInspected(const AssetSurvey& survey) {
  return survey.state == AssetState::hot || survey.state == AssetState::nothing_found;
}

/// Number of the last mission that inspected an asset.
std::string lastInspection(const Surveys& surveys, std::size_t asset) {
  for (std::size_t i = surveys.size(); i-- > 0;) {
    if (isInspected(surveys[i][asset])) return missionNumber(i);
  }
  return "never";
}

std::string stateOf(const AssetSurvey& survey) {
  switch (survey.state) {
    case AssetState::hot:
      return std::string("<span class=\"chip s3\">") +
             (survey.over_above || survey.over_delta ? "over its limit" : "hot") + "</span>";
    case AssetState::nothing_found:
      return "<span class=\"chip s0\">inspected, nothing found</span>";
    case AssetState::partly_seen:
      return "partly seen, nothing found";
    case AssetState::not_seen:
      return "<b>not seen</b>";
  }
  return "";
}

/// Links to a mission's hot spots by their ids.
std::string spotLinks(const ReportContents& contents, const AssetSurvey& survey, std::size_t mission) {
  std::string links;
  for (const std::size_t k : survey.hotspots) {
    const int id = idOf(contents.report.found, mission, k);
    links += fmt::format("{}<a href=\"#spot-{}\">{}</a>", links.empty() ? "" : ", ", id, id);
  }
  return links.empty() ? "-" : links;
}

std::string twinText(const TwinDifference& over, const SeverityTable& table) {
  std::string text = fmt::format("{:+.1f} of {}", over.p95, over.twins);
  const SeverityClass* similar = table.classOf(SeverityBasis::over_similar, over.p95);
  if (similar != nullptr) text += ", " + escaped(similar->name);
  return text;
}

/// How the assets' temperatures were corrected.
std::string emissivityNote(const HotspotJudgement& judgement) {
  if (!judgement.assumed_emissivity)
    return "Temperatures are as the map holds them, not corrected for the asset's own emissivity.";
  return fmt::format(
      "Assets that give their emissivity have their temperatures corrected for it, from the {:g} that the "
      "missions took all surfaces for, with surroundings as warm as the air.",
      *judgement.assumed_emissivity);
}

std::string limitText(const AssetLimits& limits) {
  std::string text;
  if (limits.above) text = fmt::format("{:g} &deg;C", *limits.above);
  if (limits.delta) text += fmt::format("{}{:+g} &deg;C", text.empty() ? "" : ", ", *limits.delta);
  return text.empty() ? "-" : text;
}

std::string surveyTable(const ReportContents& contents, const Surveys& surveys) {
  const std::size_t last = surveys.size() - 1;
  HtmlTable table({"asset", "state", "coverage", "max &deg;C", "mean &deg;C", "over its<br>twins", "limits",
                   "hot<br>spots", "last<br>inspected"},
                  "llrrrrrrr");
  for (std::size_t a = 0; a < surveys[last].size(); ++a) {
    const AssetSurvey& survey = surveys[last][a];
    const Asset& asset = contents.report.judgement.assets[a];
    const auto& temperatures = survey.temperatures;
    table.row(
        {named(asset.name), stateOf(survey),
         survey.surface_cells == 0 ? "no surface" : shareText(survey.coloured_cells, survey.surface_cells),
         temperatures ? estimateText(temperatures->hottest) : "-",
         temperatures ? fmt::format("{:.1f}", temperatures->mean) : "-",
         survey.over_twins ? twinText(*survey.over_twins, contents.report.judgement.table) : "-",
         limitText(asset.limits), spotLinks(contents, survey, last), lastInspection(surveys, a)});
  }
  return table.html();
}

std::string missingList(const ReportContents& contents, const std::vector<AssetSurvey>& surveys,
                        AssetState state, const std::string& heading, const std::string& none) {
  std::string items;
  for (std::size_t a = 0; a < surveys.size(); ++a) {
    if (surveys[a].state != state) continue;
    items += "<li>" + named(contents.report.judgement.assets[a].name) + " (" +
             shareText(surveys[a].coloured_cells, surveys[a].surface_cells) + " of its surface)</li>\n";
  }
  return "<h3>" + heading + "</h3>\n" +
         (items.empty() ? "<p>" + none + "</p>\n" : "<ul>\n" + items + "</ul>\n");
}

}  // namespace

std::string assetSection(const ReportContents& contents) {
  if (contents.report.judgement.assets.size() == 0 || contents.missions().empty()) return "";
  const Surveys surveys = surveysOf(contents);
  const std::size_t last = surveys.size() - 1;
  std::string text =
      "<section class=\"spot\" id=\"assets\">\n<h2>Assets</h2>\n<p>In the last mission, " +
      missionNumber(last) + ": " + named(contents.missions()[last].name) + ".</p>\n" +
      surveyTable(contents, surveys) +
      "<p class=\"note\">Coverage: share of the asset's surface in the map of which the mission has "
      "temperatures; "
      "from half on an asset counts as inspected. Over its twins: 95th percentile of its cells against the "
      "median of those twins that were inspected, how many these are, and the class of that rise over like "
      "parts. " +
      emissivityNote(contents.report.judgement) + " Last inspected: number of the mission.</p>\n";
  text += missingList(contents, surveys[last], AssetState::not_seen, "Assets not inspected: not seen",
                      "The last mission saw something of every asset.");
  return text +
         missingList(contents, surveys[last], AssetState::partly_seen,
                     "Assets not inspected: too little seen", "None.") +
         "</section>\n";
}

}  // namespace thermovox
