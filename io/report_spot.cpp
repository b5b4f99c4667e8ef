// The page of one hot spot.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "io/report_drawings.hpp"
#include "io/report_html.hpp"
#include "io/report_plot.hpp"
#include "io/report_sections.hpp"

namespace thermovox {
namespace {

std::string celsius(const Estimate& estimate) {
  return estimateText(estimate) + " &deg;C";
}

std::string mapFigure(const ReportContents& contents, const HotspotRow& row) {
  const std::size_t mission = contents.trackOf(row).lastSeen();
  const SpotPicture drawn = drawSpot(*row.spot, *contents.report.found.layers[mission]);
  const std::string from = drawn.along_normal ? "along the normal of the surface"
                                              : "along +y (the normal of the surface is not known)";
  const std::string label = fmt::format("Temperatures around hot spot {}", row.id);
  return "<figure class=\"block spot-picture\">" + spotDrawing(drawn, *row.spot, label) +
         fmt::format(
             "<figcaption>The map's temperatures of mission {}, seen {}. Blue: the 95 % ellipsoid of the "
             "position. Light grey: no temperature.</figcaption></figure>\n",
             missionNumber(mission), from);
}

std::string cropFigure(const FrameCrop& crop, const HotspotRow& row, const std::string& camera) {
  return "<figure class=\"block\">" +
         cropDrawing(crop, fmt::format("Hot spot {} in an image of the {} camera", row.id, camera)) +
         fmt::format(
             "<figcaption>The {} camera's {}, {}, around pixel ({:.1f}, {:.1f}).</figcaption></figure>\n",
             camera, named(crop.name), dateText(crop.stamp), crop.pixel.x(), crop.pixel.y());
}

/// The spot as the cameras and the map have it, side by side; the map alone where there are no images.
std::string pictureRow(const ReportContents& contents, const HotspotRow& row) {
  const auto images = contents.report.images.find(row.id);
  std::string figures;
  if (images != contents.report.images.end()) {
    const auto& [thermal, visible] = images->second;
    if (thermal) figures += cropFigure(*thermal, row, "thermal");
    if (visible) figures += cropFigure(*visible, row, "visible");
  }
  return "<div class=\"pictures\">" + figures + mapFigure(contents, row) + "</div>\n";
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
                    {"one sigma, shared", millimetres(position.common)}}) +
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

std::string readsLowText(const Hotspot& spot) {
  if (spot.is_bound) {
    return "<b>yes</b>: under 3 &times; 3 pixels, or more blur than can be put back; the true peak is higher";
  }
  return spot.readsLow() ? "<b>yes</b>: its peak is not known to 2 &deg;C" : "no";
}

std::string temperatureBlock(const ReportContents& contents, const HotspotRow& row) {
  const Hotspot& spot = *row.spot;
  std::string severity = severityChip(row, contents.report.judgement.table);
  if (!row.action.empty()) severity.append(1, ' ').append(escaped(row.action));
  const std::string similar = row.severity_similar.empty() ? "none" : escaped(row.severity_similar);
  std::vector<std::pair<std::string, std::string>> facts{
      {"severity", severity},
      {"peak", celsius({spot.peak.value, spot.peakSigma()})},
      {"the camera's bias in it", fmt::format("&pm; {:.1f} &deg;C", spot.bias_sigma)}};
  if (row.corrected_peak) facts.emplace_back("peak, for its emissivity", celsius(*row.corrected_peak));
  facts.insert(facts.end(),
               {{"over its surroundings",
                 celsius({spot.delta.value, spot.deltaSigma()}) + " (class: " + similar + ")"},
                {"surroundings", celsius(spot.reference)},
                {"over the air", fmt::format("{:.1f} &deg;C (air: {:.1f} &deg;C)",
                                             judgedPeak(row) - row.ambient, row.ambient)},
                {"hottest cell", fmt::format("{:.1f} &deg;C", spot.hottest_cell)},
                {"95th percentile, mean", fmt::format("{:.1f}, {:.1f} &deg;C", spot.p95, spot.mean)},
                {"reads low", readsLowText(spot)}});
  return "<h3>Temperatures</h3>\n" + factTable(facts);
}

std::string sizeBlock(const HotspotRow& row) {
  const Hotspot& spot = *row.spot;
  return "<h3>Size</h3>\n" +
         factTable({{"asset", row.asset.empty() ? "none" : named(row.asset)},
                    {"area, cells",
                     fmt::format("{:.0f} cm&sup2;, {}", 1e4 * spot.area, groupedText(spot.cells.size()))},
                    {"extent x, y, z", vectorText(100.0 * spot.extent, 0) + " cm"},
                    {"width, one sigma",
                     spot.width > 0.0 ? fmt::format("{:.1f} cm", 100.0 * spot.width) : "not fitted"}});
}

std::string viewBlock(const HotspotRow& row) {
  const Hotspot& spot = *row.spot;
  return "<h3>Views</h3>\n" + factTable({{"best view", viewText(spot)},
                                         {"temperatures", groupedText(spot.observations)},
                                         {"first seen", dateText(row.first_seen)},
                                         {"last seen", dateText(row.last_seen)}});
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
    points.push_back({missionNumber(i), deltaOf(track, i), track.seen[i].has_value(),
                      track.changes[i] ? "not observed" : "before"});
  }
  return "<figure class=\"block\">" +
         trendPlot(points, fmt::format("Rise of hot spot {} over its surroundings, by mission", row.id)) +
         "<figcaption>Rise over the surroundings by mission, with bars of 95 %. Filled: found as a hot spot; "
         "hollow: looked at, but no hot spot; before: not yet known.</figcaption></figure>\n";
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
         seen ? estimateText({seen->peak.value, seen->peakSigma()}) : "-", delta ? estimateText(*delta) : "-",
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
  text += pictureRow(contents, row);
  text += "<div class=\"columns\"><div>" + positionBlock(row) + viewBlock(row) + "</div><div>" +
          temperatureBlock(contents, row) + sizeBlock(row) + "</div></div>\n";
  text += "<h3>History</h3>\n";
  if (contents.missions().size() > 1) text += trendFigure(contents, row);
  return text + historyTable(contents, row) + "</section>\n";
}

}  // namespace thermovox
