#include "io/hotspot_table.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/number_text.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json jsonOf(const Eigen::Matrix3d& m) {
  return {jsonOf(Eigen::Vector3d(m.row(0))), jsonOf(Eigen::Vector3d(m.row(1))),
          jsonOf(Eigen::Vector3d(m.row(2)))};
}

Json orNull(const std::optional<Estimate>& estimate) {
  return estimate ? Json(estimate->value) : Json(nullptr);
}

Json viewJson(const Hotspot& spot) {
  const bool known = !std::isnan(spot.best_view.incidence);
  return {{"range", spot.best_view.range},
          {"incidence", known ? Json(spot.best_view.incidence) : Json(nullptr)},
          {"pixels", spot.pixels},
          {"frame", spot.best_frame ? Json(toUnixSeconds(spot.best_frame->stamp)) : Json(nullptr)},
          {"pixel",
           spot.best_frame ? Json({spot.best_frame->pixel.x(), spot.best_frame->pixel.y()}) : Json(nullptr)}};
}

Json rowJson(const HotspotRow& row) {
  const Hotspot& spot = *row.spot;
  return {{"id", row.id},
          {"position", jsonOf(spot.position.p_world)},
          {"covariance", jsonOf(spot.position.covariance())},
          {"covariance_random", jsonOf(spot.position.random)},
          {"covariance_common", jsonOf(spot.position.common)},
          {"peak", spot.peak.value},
          {"peak_sigma", std::hypot(spot.peak.sigma, spot.bias_sigma)},
          {"bias_sigma", spot.bias_sigma},
          {"hottest_cell", spot.hottest_cell},
          {"p95", spot.p95},
          {"mean", spot.mean},
          {"reference", spot.reference.value},
          {"delta", spot.delta.value},
          {"delta_sigma", spot.delta.sigma},
          {"ambient", row.ambient},
          {"area", spot.area},
          {"extent", jsonOf(spot.extent)},
          {"voxels", spot.cells.size()},
          {"observations", spot.observations},
          {"reads_low", spot.reads_low},
          {"severity", row.severity},
          {"action", row.action},
          {"asset", row.asset},
          {"state", nameOf(row.change.state)},
          {"best_view", viewJson(spot)},
          {"first_seen", toUnixSeconds(row.first_seen)},
          {"last_seen", toUnixSeconds(row.last_seen)},
          {"missions", row.missions}};
}

std::string textOf(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Keys in the order of the first level, parts of arrays and objects behind a dot.
void appendColumns(const Json& json, const std::string& name,
                   std::vector<std::pair<std::string, std::string>>& columns) {
  if (json.is_array() && (json.empty() || json.front().is_string())) {
    std::string joined;
    for (const Json& entry : json) {
      if (!joined.empty()) joined += ';';
      joined += entry.get<std::string>();
    }
    columns.emplace_back(name, joined);
  } else if (json.is_structured()) {
    for (const auto& [key, value] : json.items()) appendColumns(value, name + "." + key, columns);
  } else if (json.is_string()) {
    columns.emplace_back(name, json.get<std::string>());
  } else {
    columns.emplace_back(name, json.is_null() ? "" : json.is_number_float() ? exactText(json) : json.dump());
  }
}

/// In quotes where it has to be, as RFC 4180 says.
std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  quoted += '"';
  return quoted;
}

std::string csvLine(const std::vector<std::pair<std::string, std::string>>& columns, bool names) {
  std::string line;
  for (const auto& [name, value] : columns) {
    if (!line.empty()) line += ',';
    line += csvField(names ? name : value);
  }
  line += '\n';
  return line;
}

std::vector<std::pair<std::string, std::string>> columnsOf(const HotspotRow& row) {
  std::vector<std::pair<std::string, std::string>> columns;
  Json json = rowJson(row);
  Json& pixel = json["best_view"]["pixel"];
  if (pixel.is_null()) pixel = {nullptr, nullptr};  // every row has the same columns
  for (const auto& [key, value] : json.items()) appendColumns(value, key, columns);
  return columns;
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
    if (const SeverityClass* severity =
            judgement.table.classOf(SeverityBasis::over_ambient, row.spot->peak.value - row.ambient)) {
      row.severity = severity->name;
      row.action = severity->action;
    }
    if (const auto asset = judgement.assets.of(*row.spot, found.layers[last]->resolution())) {
      row.asset = judgement.assets[*asset].name;
    }
    fillSights(track, found, row);
    rows.push_back(std::move(row));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const HotspotRow& a, const HotspotRow& b) {
    return a.spot->peak.value > b.spot->peak.value;
  });
  return rows;
}

std::string hotspotsJson(const std::vector<HotspotRow>& rows) {
  Json json{{"hotspots", Json::array()}};
  for (const HotspotRow& row : rows) json["hotspots"].push_back(rowJson(row));
  return textOf(json);
}

void writeHotspotsCsv(const std::filesystem::path& file, const std::vector<HotspotRow>& rows,
                      Existing existing) {
  const Hotspot none;
  AtomicFile out(file, existing);
  out.write(csvLine(columnsOf(rows.empty() ? HotspotRow{.spot = &none} : rows.front()), true));
  for (const HotspotRow& row : rows) out.write(csvLine(columnsOf(row), false));
  out.commit();
}

std::string differencesJson(const StationHotspots& found, std::size_t from, std::size_t to) {
  Json json{
      {"from", found.missions[from].name}, {"to", found.missions[to].name}, {"hotspots", Json::array()}};
  for (const auto& [place, change] : found.history.between(from, to)) {
    const HotspotTrack& track = found.history.tracks()[place];
    const Hotspot& spot = track.seen[to] ? *track.seen[to] : *track.seen[from];
    const bool known = change.from && change.to;
    json["hotspots"].push_back({{"id", track.id},
                                {"state", nameOf(change.state)},
                                {"position", jsonOf(spot.position.p_world)},
                                {"delta_from", orNull(change.from)},
                                {"delta_to", orNull(change.to)},
                                {"change", known ? Json(change.change.value) : Json(nullptr)},
                                {"sigma", known ? Json(change.change.sigma) : Json(nullptr)},
                                {"significance", known ? Json(change.significance()) : Json(nullptr)},
                                {"alarm", change.alarm}});
  }
  return textOf(json);
}

}  // namespace thermovox
