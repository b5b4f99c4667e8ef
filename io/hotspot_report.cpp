#include "io/hotspot_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "io/report_html.hpp"
#include "io/report_sections.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr HotspotState kStates[] = {HotspotState::fresh,   HotspotState::growing, HotspotState::steady,
                                    HotspotState::cooling, HotspotState::gone,    HotspotState::not_observed};

std::string wordOf(HotspotState state) {
  return state == HotspotState::not_observed ? "not observed" : nameOf(state);
}

template <typename Matches>
std::string countOf(const ReportContents& contents, Matches&& matches) {
  return groupedText(
      static_cast<std::size_t>(std::count_if(contents.rows.begin(), contents.rows.end(), matches)));
}

/// What the rises are counted from, in the order of the table's classes; then what has none.
std::vector<std::pair<std::string, std::string>> severityCounts(const ReportContents& contents) {
  std::vector<std::pair<std::string, std::string>> counts;
  const std::vector<HotspotRow> now = standing(contents.rows);
  const auto count = [&](const std::string& name) {
    return groupedText(static_cast<std::size_t>(
        std::count_if(now.begin(), now.end(), [&](const HotspotRow& row) { return row.severity == name; })));
  };
  for (const SeverityClass& entry : contents.report.judgement.table.over_ambient) {
    counts.emplace_back(escaped(entry.name), count(entry.name));
  }
  counts.emplace_back("none", count(""));
  return counts;
}

std::vector<std::pair<std::string, std::string>> stateCounts(const ReportContents& contents) {
  std::vector<std::pair<std::string, std::string>> counts;
  for (const HotspotState state : kStates) {
    counts.emplace_back(wordOf(state),
                        countOf(contents, [&](const HotspotRow& row) { return row.change.state == state; }));
  }
  return counts;
}

constexpr const char* kMethods = R"html(<dl>
<dt>Temperatures</dt><dd>Of a cell: the mean of all readings that the thermal frames gave its surface, each weighted by
its own error (noise of the camera, and how far off the frame may have been placed). Every mission has its own.</dd>
<dt>Hot spots</dt><dd>Found in each mission alone. Cells that meet the criterion make clusters; a Gaussian peak over a plane
is fitted to the temperatures around each. Clusters of fewer than three cells, or that stand out by less than three
sigmas, are none.</dd>
<dt>Peak</dt><dd>Of the fitted peak, with what lens, pixels and cells take off put back. Its sigma holds noise, fit and the
camera's bias, which all temperatures share. Where the fit fails: the hottest cell, marked as reading low.</dd>
<dt>Rise over the surroundings</dt><dd>Peak less the median of the ring around it on the same surface; the camera's bias
cancels. Missions are compared on this alone, so that a warmer season changes nothing.</dd>
<dt>Severity</dt><dd>By the rise over the air, in the table named above.</dd>
<dt>Position and its ellipsoid</dt><dd>The centre of the fitted peak. Random: noise of ranges and temperatures. Shared:
mounting, range bias and poses as the missions declare them, which more readings do not shrink. The ellipsoid holds the
true place with 95 % (7.815, chi squared with three degrees of freedom), if what is declared is true.</dd>
<dt>Area, extent, cells</dt><dd>Of the cells that meet the criterion.</dd>
<dt>Identity and state</dt><dd>Spots of two missions are one where their places and sizes agree within their errors (99.9 %).
A change counts from 2 &deg;C on, at three and a half sigmas: growing or cooling, else steady. Gone: the place was looked at and is
not hot. Not observed: too little of the place was seen to tell; it may be as hot as before.</dd>
<dt>Limits</dt><dd>Emissivity and reflections are as the missions assumed them. A shiny or sheltered part may be hotter than it
looks, and a reflection may look like a hot spot.</dd>
</dl>
)html";

}  // namespace

const HotspotTrack& ReportContents::trackOf(const HotspotRow& row) const {
  return thermovox::trackOf(report.found, row);
}

std::string severityChip(const HotspotRow& row, const SeverityTable& table) {
  const std::vector<SeverityClass>& classes = table.over_ambient;
  const auto place = std::find_if(classes.begin(), classes.end(),
                                  [&](const SeverityClass& entry) { return entry.name == row.severity; });
  std::ptrdiff_t colour = 0;  // of report_style: 1 to 4, the last class has the last
  if (place != classes.end()) colour = 4 - std::min<std::ptrdiff_t>(3, classes.end() - 1 - place);
  return fmt::format("<span class=\"chip s{}\">{}</span>", colour,
                     row.severity.empty() ? "none" : escaped(row.severity));
}

std::string stateText(const HotspotChange& change) {
  const std::string word = wordOf(change.state);
  return change.alarm ? "<b>" + word + "</b>" : word;
}

std::vector<HotspotRow> standing(const std::vector<HotspotRow>& rows) {
  std::vector<HotspotRow> now;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(now), [](const HotspotRow& row) {
    return row.change.state != HotspotState::gone && row.change.state != HotspotState::not_observed;
  });
  return now;
}

std::string missionNumber(std::size_t mission) {
  return std::to_string(mission + 1);
}

std::string countSection(const ReportContents& contents) {
  return "<section class=\"spot\">\n<h2 id=\"counts\">In all</h2>\n<p>" +
         countText(contents.rows.size(), "hot spot") + " in " +
         countText(contents.missions().size(), "mission") + "; " +
         countOf(contents, [](const HotspotRow& row) { return row.change.alarm; }) +
         " new or growing in the last, " +
         countOf(contents, [](const HotspotRow& row) { return row.spot->readsLow(); }) +
         " that read low.</p>\n<div class=\"columns\"><div class=\"block\"><h3>By severity, gone and not "
         "observed ones apart</h3>\n" +
         factTable(severityCounts(contents)) +
         "</div><div class=\"block\"><h3>By state in the last mission</h3>\n" +
         factTable(stateCounts(contents)) + "</div></div>\n";
}

std::string methodSection() {
  return std::string("<h2 id=\"methods\">How each number was made</h2>\n") + kMethods + "</section>\n";
}

std::string hotspotReportHtml(const HotspotReport& report) {
  ReportContents contents{report, hotspotRows(report.found, report.judgement), {}, surfaceCloud(report.map)};
  if (contents.points.empty()) {
    throw DataError(report.station + ": holds no surface, expected a map to report of");
  }
  for (std::size_t i = 0; i < contents.missions().size(); ++i) {
    contents.ambients.push_back(ambientOf(report.found, i, report.judgement.ambient));
  }
  std::string body =
      coverSection(contents) + conditionSection(contents) + mapSection(contents) + summarySection(contents);
  for (const HotspotRow& row : contents.rows) body += spotSection(contents, row);
  body += assetSection(contents) + countSection(contents) + methodSection();
  return htmlDocument(report.title, body);
}

}  // namespace thermovox
