// The page of one hot spot.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/report_drawings.hpp"
#include "io/report_html.hpp"
#include "io/report_plot.hpp"
#include "io/report_sections.hpp"

namespace thermovox {
namespace {

std::string celsius(const Estimate& estimate) {
  return estimateText(estimate) + " &deg;C";
}

std::string pictureFigure(const ReportContents& contents, const HotspotRow& row) {
  const std::size_t mission = contents.trackOf(row).lastSeen();
  const SpotPicture drawn = drawSpot(*row.spot, *contents.report.found.layers[mission]);
  const std::string from = drawn.along_normal ? "along the normal of the surface"
                                              : "along +y (the normal of the surface is not known)";
  const std::string label = fmt::format("Temperatures around hot spot {}", row.id);
  return "<figure class=\"block\">" + spotDrawing(drawn, *row.spot, label) +
         fmt::format(
             "<figcaption>Rendered from the temperatures of mission {} in the map, seen {}: the station "
             "keeps no images. Blue: the 95 % ellipsoid of the position. Light grey: no "
             "temperature.</figcaption></figure>\n",
             missionNumber(mission), from);
}

std::string positionBlock(const HotspotRow& row) {
  const HotspotPosition& position = row.spot->position;
  const Ellipsoid ellipsoid = ellipsoidOf(position);
  HtmlTable axes({"half axis (95 %)", "direction x, y, z"}, "rr");
  for (int i = 0; i < 3; ++i) {
    axes.row(
        {fmt::format("{:.1f} mm", 1e3 * ellipsoid.half_axes[i]), vectorText(ellipsoid.directions.col(i), 2)});
  }
  const auto millimetres = [](const Eigen::Matrix3d& covariance) {
    return fmt::format("{:.1f} mm", 1e3 * std::sqrt(covariance.trace()));
  };
  return "<h3>Position</h3>\n" +
         factTable({{"x, y, z (world)", vectorText(position.p_world, 3) + " m"},
                    {"one sigma, random", millimetres(position.random)},
                    {"one sigma, shared by the mission", millimetres(position.common)}}) +
         axes.html();
}

std::string viewText(const Hotspot& spot) {
  if (spot.observations == 0) return "none";
  const double incidence = spot.best_view.incidence;
  return fmt::format("{:.1f} px on the spot from {:.2f} m", spot.pixels, spot.best_view.range) +
         (std::isnan(incidence)
              ? std::string()
              : fmt::format(", {:.0f}&deg; off the normal", incidence * 180.0 / std::numbers::pi));
}

const char* readsLowText(const Hotspot& spot) {
  return spot.reads_low
             ? "<b>yes</b>: under 3 &times; 3 pixels, or more blur than can be put back; the true peak "
               "is higher"
             : "no";
}

std::string valueTables(const ReportContents& contents, const HotspotRow& row) {
  const Hotspot& spot = *row.spot;
  std::string severity = severityChip(row, contents.report.judgement.table);
  if (!row.action.empty()) severity.append(1, ' ').append(escaped(row.action));
  const std::string temperatures = factTable(
      {{"severity", severity},
       {"peak", celsius({spot.peak.value, std::hypot(spot.peak.sigma, spot.bias_sigma)})},
       {"of that the camera's bias", fmt::format("&pm; {:.1f} &deg;C", spot.bias_sigma)},
       {"over its surroundings", celsius(spot.delta)},
       {"surroundings, same surface", celsius(spot.reference)},
       {"over the air",
        fmt::format("{:.1f} &deg;C (air: {:.1f} &deg;C)", spot.peak.value - row.ambient, row.ambient)},
       {"hottest cell", fmt::format("{:.1f} &deg;C", spot.hottest_cell)},
       {"95th percentile, mean of its cells", fmt::format("{:.1f}, {:.1f} &deg;C", spot.p95, spot.mean)},
       {"reads low", readsLowText(spot)}});
  const std::string seen = factTable(
      {{"asset", row.asset.empty() ? "none" : named(row.asset)},
       {"area", fmt::format("{:.0f} cm&sup2;", 1e4 * spot.area)},
       {"extent x, y, z", vectorText(100.0 * spot.extent, 0) + " cm"},
       {"width of the peak (one sigma)",
        spot.width > 0.0 ? fmt::format("{:.1f} cm", 100.0 * spot.width) : "not fitted"},
       {"cells, observations", groupedText(spot.cells.size()) + ", " + groupedText(spot.observations)},
       {"best view", viewText(spot)},
       {"first seen", dateText(row.first_seen)},
       {"last seen", dateText(row.last_seen)}});
  return "<div class=\"columns even\"><div><h3>Temperatures</h3>\n" + temperatures +
         "</div><div><h3>Size and view</h3>\n" + seen + "</div></div>\n";
}

/// Delta of a mission, be it of a hot spot or of the place where one was.
std::optional<Estimate> deltaOf(const HotspotTrack& track, std::size_t mission) {
  if (track.seen[mission]) return track.seen[mission]->delta;
  return track.changes[mission] ? track.changes[mission]->to : std::nullopt;
}

std::string trendFigure(const ReportContents& contents, const HotspotRow& row) {
  const HotspotTrack& track = contents.trackOf(row);
  std::vector<TrendPoint> points;
  for (std::size_t i = 0; i < contents.missions().size(); ++i) {
    points.push_back({missionNumber(i), deltaOf(track, i), track.seen[i].has_value()});
  }
  return "<figure class=\"block\">" +
         trendPlot(points, fmt::format("Rise of hot spot {} over its surroundings, by mission", row.id)) +
         "<figcaption>Rise over the surroundings by mission, with bars of 95 %. Filled: found as a hot spot; "
         "hollow: looked at, but no hot spot.</figcaption></figure>\n";
}

std::string historyTable(const ReportContents& contents, const HotspotRow& row) {
  const HotspotTrack& track = contents.trackOf(row);
  HtmlTable table(
      {"#", "mission", "flown", "peak &deg;C", "over its<br>surroundings", "change", "sigmas", "state"},
      "rllrrrrl");
  for (std::size_t i = 0; i < contents.missions().size(); ++i) {
    const MissionRecord& mission = contents.missions()[i];
    const std::optional<Hotspot>& seen = track.seen[i];
    const std::optional<HotspotChange>& change = track.changes[i];
    const std::optional<Estimate> delta = deltaOf(track, i);
    const bool compared = change && change->from && change->to;
    table.row(
        {missionNumber(i), named(mission.name), mission.first ? dateText(*mission.first) : "not known",
         seen ? estimateText({seen->peak.value, std::hypot(seen->peak.sigma, seen->bias_sigma)}) : "-",
         delta ? estimateText(*delta) : "-",
         compared ? fmt::format("{:+.1f} &pm; {:.1f}", change->change.value, change->change.sigma) : "-",
         compared ? fmt::format("{:.1f}", change->significance()) : "-",
         change ? stateText(*change) : "before the first sight"});
  }
  return table.html();
}

}  // namespace

Ellipsoid ellipsoidOf(const HotspotPosition& position) {
  constexpr double kChi95 = 7.815;
  const Eigen::Matrix3d covariance = position.covariance();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (covariance + covariance.transpose()));
  Ellipsoid ellipsoid;
  for (int i = 0; i < 3; ++i) {  // the solver's are ascending
    ellipsoid.half_axes[i] = std::sqrt(kChi95 * std::max(solver.eigenvalues()[2 - i], 0.0));
    Eigen::Vector3d direction = solver.eigenvectors().col(2 - i);
    Eigen::Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    if (direction[largest] < 0.0) direction = -direction;
    ellipsoid.directions.col(i) = direction;
  }
  return ellipsoid;
}

std::string spotSection(const ReportContents& contents, const HotspotRow& row) {
  std::string text = fmt::format("<section class=\"spot\" id=\"spot-{0}\">\n<h2>Hot spot {0} {1} {2}", row.id,
                                 severityChip(row, contents.report.judgement.table), stateText(row.change));
  text += fmt::format(" <a class=\"back\" href=\"#row-{}\">back to the list</a></h2>\n", row.id);
  text += "<div class=\"columns\"><div>" + pictureFigure(contents, row) + "</div><div>" + positionBlock(row) +
          "</div></div>\n";
  text += valueTables(contents, row);
  text += "<h3>History</h3>\n";
  if (contents.missions().size() > 1) text += trendFigure(contents, row);
  return text + historyTable(contents, row) + "</section>\n";
}

}  // namespace thermovox
