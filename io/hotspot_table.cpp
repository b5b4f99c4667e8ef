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

/// Cells remember views to 1/100; a single float would show digits that nobody has measured.
double tenThousandths(float value) {
  return std::round(1e4 * static_cast<double>(value)) / 1e4;
}

Json viewJson(const Hotspot& spot) {
  const bool known = !std::isnan(spot.best_view.incidence);
  return {{"range", tenThousandths(spot.best_view.range)},
          {"incidence", known ? Json(tenThousandths(spot.best_view.incidence)) : Json(nullptr)},
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
          {"peak_sigma", spot.peakSigma()},
          {"bias_sigma", spot.bias_sigma},
          {"hottest_cell", spot.hottest_cell},
          {"p95", spot.p95},
          {"mean", spot.mean},
          {"reference", spot.reference.value},
          {"delta", spot.delta.value},
          {"delta_sigma", spot.deltaSigma()},
          {"ambient", row.ambient},
          {"area", spot.area},
          {"extent", jsonOf(spot.extent)},
          {"voxels", spot.cells.size()},
          {"observations", spot.observations},
          {"reads_low", spot.readsLow()},
          {"peak_corrected", orNull(row.corrected_peak)},
          {"peak_corrected_sigma", row.corrected_peak ? Json(row.corrected_peak->sigma) : Json(nullptr)},
          {"severity", row.severity},
          {"action", row.action},
          {"severity_similar", row.severity_similar},
          {"asset", row.asset},
          {"state", nameOf(row.change.state)},
          {"alarm", row.change.alarm},
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

/// What each mission made of a hot spot, from its first sight on.
Json historyJson(const StationHotspots& found, const HotspotRow& row) {
  const HotspotTrack& track = trackOf(found, row);
  Json history = Json::array();
  for (std::size_t i = 0; i < found.missions.size(); ++i) {
    const std::optional<HotspotChange>& change = track.changes[i];
    if (!change) continue;
    history.push_back({{"mission", found.missions[i].name},
                       {"state", nameOf(change->state)},
                       {"delta", orNull(change->to)},
                       {"delta_sigma", change->to ? Json(change->to->sigma) : Json(nullptr)},
                       {"alarm", change->alarm}});
  }
  return history;
}

Json missionJson(const StationHotspots& found, std::size_t mission, const HotspotJudgement& judgement) {
  const MissionRecord& record = found.missions[mission];
  const std::size_t cells = found.layers[mission]->samples().size();
  return {{"name", record.name},
          {"first", record.first ? Json(toUnixSeconds(*record.first)) : Json(nullptr)},
          {"last", record.last ? Json(toUnixSeconds(*record.last)) : Json(nullptr)},
          {"points", record.points},
          {"coloured", record.coloured},
          {"cells", cells},
          {"ambient", cells > 0 ? Json(ambientOf(found, mission, judgement.ambient)) : Json(nullptr)}};
}

Json assetJson(const HotspotList& list, std::size_t asset) {
  const AssetSurvey& survey = list.surveys[asset];
  const std::size_t last = list.found.missions.size() - 1;
  Json ids = Json::array();
  for (const std::size_t spot : survey.hotspots) ids.push_back(idOf(list.found, last, spot));
  const auto& of = survey.temperatures;
  const auto& over = survey.over_twins;
  const SeverityClass* similar =
      over ? list.judgement.table.classOf(SeverityBasis::over_similar, over->p95) : nullptr;
  return {{"name", list.judgement.assets[asset].name},
          {"state", nameOf(survey.state)},
          {"coverage", survey.coverage()},
          {"max", of ? Json(of->hottest.value) : Json(nullptr)},
          {"max_sigma", of ? Json(of->hottest.sigma) : Json(nullptr)},
          {"p95", of ? Json(of->p95) : Json(nullptr)},
          {"mean", of ? Json(of->mean) : Json(nullptr)},
          {"corrected", of && of->corrected},
          {"over_twins", over ? Json(over->p95) : Json(nullptr)},
          {"twins", over ? over->twins : 0},
          {"severity_similar", similar != nullptr ? similar->name : ""},
          {"over_limit", survey.over_above || survey.over_delta},
          {"hotspots", ids}};
}

}  // namespace

std::string hotspotsJson(const HotspotList& list) {
  Json json{{"hotspots", Json::array()}, {"missions", Json::array()}};
  for (const HotspotRow& row : list.rows) {
    json["hotspots"].push_back(rowJson(row));
    json["hotspots"].back()["history"] = historyJson(list.found, row);
  }
  for (std::size_t i = 0; i < list.found.missions.size(); ++i) {
    json["missions"].push_back(missionJson(list.found, i, list.judgement));
  }
  for (std::size_t i = 0; i < list.surveys.size(); ++i) {
    json["assets"].push_back(assetJson(list, i));
  }
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
