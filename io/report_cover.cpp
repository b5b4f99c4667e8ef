// The first pages: what was inspected, how and when, and the list of what was found.

#include <fmt/format.h>

#include <algorithm>

#include "io/report_drawings.hpp"
#include "io/report_html.hpp"
#include "io/report_sections.hpp"

namespace thermovox {
namespace {

std::size_t colouredCells(const ReportContents& contents) {
  return static_cast<std::size_t>(std::count_if(contents.points.begin(), contents.points.end(),
                                                [](const SurfacePoint& p) { return p.temperature; }));
}

std::string coverageText(const ReportContents& contents) {
  const std::size_t coloured = colouredCells(contents);
  return fmt::format(
      "{} of the {} cells that hold a surface have a temperature ({}); a cell is {:.3g} cm wide",
      groupedText(coloured), groupedText(contents.points.size()), shareText(coloured, contents.points.size()),
      100.0 * contents.report.map.resolution());
}

/// Spots that earlier missions saw and the last one did not.
std::string pastText(const std::vector<HotspotRow>& rows) {
  const auto in = [&](HotspotState state) {
    return std::count_if(rows.begin(), rows.end(),
                         [state](const HotspotRow& row) { return row.change.state == state; });
  };
  const auto gone = in(HotspotState::gone), unseen = in(HotspotState::not_observed);
  if (gone + unseen == 0) return "";
  return fmt::format(
      "<p>Of earlier missions' hot spots {} gone; {} not observed in the last one and may be as hot as "
      "before.</p>\n",
      gone == 1 ? "1 is" : fmt::format("{} are", gone),
      unseen == 1 ? "1 was" : fmt::format("{} were", unseen));
}

/// What was found, first of all.
std::string verdict(const ReportContents& contents) {
  const auto alarms = static_cast<std::size_t>(std::count_if(
      contents.rows.begin(), contents.rows.end(), [](const HotspotRow& row) { return row.change.alarm; }));
  const std::vector<HotspotRow> now = standing(contents.rows);
  std::string text;
  if (now.empty()) {
    text = "<div class=\"verdict\"><p><b>No hot spot was found</b> ";
    if (!contents.rows.empty()) text += "in the last mission ";
  } else {
    const HotspotRow& first = now.front();
    text = fmt::format(
        "<div class=\"verdict alarm\"><p><b>{}</b>, the hottest <a href=\"#spot-{}\">number {}</a> of {:.1f} "
        "&deg;C",
        countText(now.size(), "hot spot"), first.id, first.id, first.spot->peak.value);
    if (contents.missions().size() > 1) text += fmt::format("; new or growing: <b>{}</b>", alarms);
    text += ", ";
  }
  text += "by the criterion: " + criteriaText(contents.report.criteria) + ".</p>\n" +
          pastText(contents.rows) + "<p>Coverage: " + coverageText(contents) + ".";
  if (contents.rows.empty()) text += " Of what has no temperature nothing can be said.";
  return text + "</p></div>\n";
}

std::string missionTable(const ReportContents& contents) {
  HtmlTable table(
      {"#", "mission", "flown", "readings", "points", "with temperature", "cells with temperature"},
      "rllrrrr");
  for (std::size_t i = 0; i < contents.missions().size(); ++i) {
    const MissionRecord& mission = contents.missions()[i];
    const std::size_t cells = contents.report.found.layers[i]->samples().size();
    std::string flown = mission.first ? dateText(*mission.first) : "not known";
    if (mission.last && mission.first) {
      flown += fmt::format("<br>for {:.1f} s", toSeconds(*mission.last - *mission.first));
    }
    table.row({missionNumber(i), named(mission.name), flown,
               groupedText(static_cast<std::size_t>(mission.readings)),
               groupedText(static_cast<std::size_t>(mission.points)),
               groupedText(static_cast<std::size_t>(mission.coloured)),
               groupedText(cells) + " (" + shareText(cells, contents.points.size()) + ")"});
  }
  std::string text = table.html();
  for (const std::string& name : contents.report.found.without_layer) {
    text += "<p class=\"note\">The station has not kept the own temperatures of " + named(name) +
            ", which was mapped by an older program.</p>\n";
  }
  return text;
}

std::vector<MapMark> marksOf(const ReportContents& contents) {
  std::vector<MapMark> marks;
  for (const HotspotRow& row : contents.rows) marks.push_back({row.id, row.spot->position.p_world});
  return marks;
}

std::string mapFigure(const ReportContents& contents, const MapPictureOptions& options,
                      const std::string& caption) {
  return "<figure>" + mapDrawing(drawMap(contents.points, options), marksOf(contents), caption) +
         "<figcaption>" + caption + "</figcaption></figure>\n";
}

}  // namespace

std::string coverSection(const ReportContents& contents) {
  const HotspotReport& report = contents.report;
  std::string text = "<header id=\"top\"><h1>" + named(report.title) +
                     "</h1>\n<p class=\"lead\">Thermal inspection of the station " + named(report.station) +
                     ", " + countText(contents.missions().size(), "mission") + ". Made with thermovox " +
                     escaped(report.version) + ".</p>\n";
  text +=
      "<nav><a href=\"#conditions\">conditions</a> <a href=\"#map\">map</a> <a href=\"#summary\">list</a> ";
  if (report.judgement.assets.size() > 0) text += "<a href=\"#assets\">assets</a> ";
  text +=
      "<a href=\"#counts\">counts</a> <a href=\"#methods\">how the numbers were made</a></nav></header>\n";
  return text + verdict(contents) + "<h2 id=\"missions\">Missions</h2>\n" + missionTable(contents);
}

std::string mapSection(const ReportContents& contents) {
  MapPictureOptions options{.resolution = contents.report.map.resolution(),
                            .style = PictureStyle::temperature,
                            .backdrop = Backdrop::white,
                            .azimuth_deg = -90.0,
                            .elevation_deg = 89.0,
                            .width_px = 1200,
                            .height_px = 760};
  std::string text =
      "<h2 id=\"map\" class=\"sheet\">Where they are</h2>\n<p class=\"note\">Surface temperatures as the map "
      "of all "
      "missions holds them; light grey has none. The ceiling and the walls towards the viewer are "
      "cut away. Marks are drawn over everything, also where a part of the plant stands before "
      "the spot.</p>\n";
  text += mapFigure(contents, options, "From above.");
  options.elevation_deg = 14.0;
  options.height_px = 560;
  text += mapFigure(contents, options, "From the aisle: level, from the long side.");
  options.azimuth_deg = -58.0;
  options.elevation_deg = 38.0;
  options.height_px = 700;
  return text + mapFigure(contents, options, "From above at an angle.");
}

std::string summarySection(const ReportContents& contents) {
  const bool is_long = contents.rows.size() > 8;  // too long for what the map leaves of a page
  std::string text = std::string("<h2 id=\"summary\"") + (is_long ? " class=\"sheet\"" : "") +
                     ">The hot spots, the hottest first</h2>\n";
  if (contents.rows.empty()) {
    return text + "<p>There is none by the criterion: " + criteriaText(contents.report.criteria) + ". " +
           coverageText(contents) + ".</p>\n";
  }
  HtmlTable table({"no.", "severity", "peak<br>&deg;C", "over its<br>surroundings", "over<br>the air",
                   "x, y, z<br>m", "&plusmn; mm<br>(95 %)", "state", "asset"},
                  "rlrrrrrll");
  for (const HotspotRow& row : contents.rows) {
    const Hotspot& spot = *row.spot;
    const double largest = ellipsoidOf(spot.position).half_axes.maxCoeff();
    table.row({fmt::format("<a href=\"#spot-{0}\" id=\"row-{0}\">{0}</a>", row.id),
               severityChip(row, contents.report.judgement.table),
               (spot.is_bound ? "&ge;&nbsp;" : "") + estimateText({spot.peak.value, spot.peakSigma()}),
               estimateText(spot.delta), fmt::format("{:.1f}", spot.peak.value - row.ambient),
               vectorText(spot.position.p_world, 3), fmt::format("{:.0f}", std::ceil(1e3 * largest)),
               stateText(row.change), named(row.asset)});
  }
  return text + table.html() +
         "<p class=\"note\">Values are those of the last mission that saw the spot, with one sigma. &ge;: "
         "reads "
         "low (under 3 &times; 3 pixels on the spot, or more blur than can be put back). &plusmn; mm: the "
         "longest half axis of the 95 % ellipsoid. The state is that of the last "
         "mission.</p>\n";
}

}  // namespace thermovox
