#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/arguments.hpp"
#include "apps/image_info.hpp"
#include "apps/radiometry_options.hpp"
#include "apps/verbs.hpp"
#include "io/capture_folder.hpp"
#include "io/csv.hpp"
#include "io/input_file.hpp"
#include "io/mission_folder.hpp"
#include "io/rig_file.hpp"
#include "io/station.hpp"
#include "projection/error.hpp"
#include "projection/kind_names.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

enum class Kind { image, mission, rig, captures, bag, station };

struct InfoArgs {
  fs::path thing;
  bool verify = false;
  bool json = false;
  RadiometricOverrides radiometry;
  ScaleArgs scale;

  [[nodiscard]] ImageKnowledge knowledge() const { return {radiometry, scale.scale()}; }
};

bool startsWith(const std::string& head, std::string_view magic) {
  return head.compare(0, magic.size(), magic) == 0;
}

bool looksLikeImage(const std::string& head) {
  using namespace std::string_view_literals;
  constexpr std::array magics{"II*\0"sv,   "MM\0*"sv, "II+\0"sv, "MM\0+"sv, "\xFF\xD8"sv,
                              "\x89PNG"sv, "BM"sv,    "FFF\0"sv, "AFF\0"sv, "GIF8"sv};
  return std::any_of(magics.begin(), magics.end(),
                     [&](std::string_view magic) { return startsWith(head, magic); });
}

/// What the thing is, by its content; a folder by the description in it.
Kind kindOf(const fs::path& thing) {
  if (fs::is_directory(thing)) {
    if (fs::exists(thing / "mission.yaml")) return Kind::mission;
    if (fs::exists(thing / "captures.yaml")) return Kind::captures;
    throw DataError(thing.string() +
                    ": is a folder without mission.yaml or captures.yaml, expected a mission or captures");
  }
  std::string head(64, '\0');
  std::ifstream stream = openInput(thing);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (startsWith(head, "SQLite format 3")) return Kind::station;
  if (startsWith(head, "#ROSBAG")) return Kind::bag;
  if (looksLikeImage(head)) return Kind::image;
  if (thing.filename() == "mission.yaml") return Kind::mission;
  if (thing.filename() == "captures.yaml") return Kind::captures;
  if (thing.extension() == ".yaml" || thing.extension() == ".yml") return Kind::rig;
  throw DataError(
      thing.string() +
      ": is nothing that thermovox knows, expected an image, mission, rig, captures, bag or station");
}

Json cameraInfo(const Camera& camera) {
  constexpr double degrees = 180.0 / M_PI;
  return {{"width", camera.width()},
          {"height", camera.height()},
          {"model", nameOf(camera.intrinsics().model)},
          {"field_of_view_deg",
           {2.0 * degrees * std::atan(0.5 * camera.width() / camera.fx()),
            2.0 * degrees * std::atan(0.5 * camera.height() / camera.fy())}}};
}

Json rigInfo(const Rig& rig) {
  Json json{{"kind", "rig"}};
  json["lasers"] = Json::array();
  for (const Laser& laser : rig.lasers) {
    json["lasers"].push_back({{"kind", nameOf(laser.kind)},
                              {"range", {laser.range_min, laser.range_max}},
                              {"range_sigma", laser.range_sigma},
                              {"calibrated", !laser.covariance_body_laser.isZero(0.0)}});
  }
  if (rig.thermal_camera) json["thermal_camera"] = cameraInfo(rig.thermal_camera->camera);
  if (rig.visible_camera) json["visible_camera"] = cameraInfo(rig.visible_camera->camera);
  return json;
}

std::size_t rowsOf(const fs::path& list) {
  CsvReader rows(std::make_unique<std::ifstream>(openInput(list)), list.string());
  std::size_t count = 0;
  while (rows.next()) ++count;
  return count;
}

Json missionInfo(const fs::path& thing) {
  const OpenedMission opened = openMission(thing);
  const MissionFile description = parseMissionFile(readWhole(opened.file), opened.file.string());
  const auto poses = opened.mission.trajectory.poses();
  std::size_t readings = 0;
  for (const std::string& list : description.lasers) readings += rowsOf(opened.folder / list);
  const std::size_t frames =
      opened.frames && description.thermal ? rowsOf(opened.folder / *description.thermal) : 0;
  Json json{{"kind", "mission"},
            {"name", opened.mission.name},
            {"readings", readings},
            {"thermal_frames", frames},
            {"poses", poses.size()},
            {"first_pose", toUnixSeconds(poses.front().stamp)},
            {"last_pose", toUnixSeconds(poses.back().stamp)}};
  Json rig = rigInfo(opened.mission.rig);
  rig.erase("kind");
  json["rig"] = std::move(rig);
  return json;
}

Json boardInfo(const CalibrationBoard& board) {
  Json json{{"pattern", nameOf(board.pattern)},
            {"columns", board.columns},
            {"rows", board.rows},
            {"square", board.square}};
  if (board.width > 0.0) json["width"] = board.width;
  if (board.height > 0.0) json["height"] = board.height;
  return json;
}

Json capturesInfo(const fs::path& thing) {
  const CaptureFolder opened = openCaptures(thing);
  const auto with = [&](std::optional<fs::path> CaptureFiles::*file) {
    return std::count_if(opened.captures.begin(), opened.captures.end(),
                         [file](const CaptureFiles& capture) { return (capture.*file).has_value(); });
  };
  Json json{{"kind", "captures"},
            {"name", opened.name},
            {"captures", opened.captures.size()},
            {"thermal", with(&CaptureFiles::thermal)},
            {"visible", with(&CaptureFiles::visible)},
            {"laser", with(&CaptureFiles::laser)},
            {"board", boardInfo(opened.board)}};
  Json rig = rigInfo(opened.rig);
  rig.erase("kind");
  json["rig"] = std::move(rig);
  return json;
}

Json stationInfo(const fs::path& file, bool verify) {
  const Station station = Station::open(file);
  const Station::Counts counts = station.counts();
  Json json{{"kind", "station"}, {"resolution", station.options().resolution}, {"voxels", counts.surfaces}};
  json["missions"] = Json::array();
  for (const MissionRecord& mission : station.missions()) {
    Json entry{{"mission", mission.name},
               {"readings", mission.readings},
               {"points", mission.points},
               {"coloured", mission.coloured}};
    if (mission.first) entry["first"] = toUnixSeconds(*mission.first);
    if (mission.last) entry["last"] = toUnixSeconds(*mission.last);
    json["missions"].push_back(std::move(entry));
  }
  if (verify) {
    const std::vector<std::string> faults = station.verify();
    json["ok"] = faults.empty();
    json["tiles"] = counts.tiles;
    if (!faults.empty()) json["faults"] = faults;
  }
  return json;
}

/// A station may be too damaged to be opened; that too is an answer.
Json verifiedStationInfo(const fs::path& file) {
  try {
    return stationInfo(file, true);
  } catch (const DataError& error) {
    return {{"kind", "station"},
            {"missions", Json::array()},
            {"ok", false},
            {"tiles", 0},
            {"faults", Json::array({error.what()})}};
  }
}

Json describe(const InfoArgs& args) {
  checkRadiometry(args.radiometry);
  const Kind kind = kindOf(args.thing);
  if (kind != Kind::image && args.knowledge().any()) {
    throw UsageError(args.thing.string() +
                     ": is no image; radiometric parameters and --celsius-per-count are of images");
  }
  switch (kind) {
    case Kind::image:
      return imageInfo(args.thing, args.knowledge());
    case Kind::mission:
      return missionInfo(args.thing);
    case Kind::rig:
      return rigInfo(readRig(args.thing));
    case Kind::captures:
      return capturesInfo(args.thing);
    case Kind::bag:
      return {{"kind", "bag"}, {"bytes", fs::file_size(args.thing)}};
    case Kind::station:
      break;
  }
  return args.verify ? verifiedStationInfo(args.thing) : stationInfo(args.thing, false);
}

/// As JSON; what is no UTF-8 (a name in a damaged file) does not stop it.
std::string text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The same content as lines "key: value", nested keys with a dot.
void printLines(const Json& json, const std::string& prefix) {
  for (const auto& [key, value] : json.items()) {
    const std::string path = prefix.empty() ? key : prefix + "." + key;
    const bool of_objects =
        value.is_object() || (value.is_array() && !value.empty() && value.front().is_object());
    if (of_objects) {
      printLines(value, path);
    } else {
      std::cout << path << ": " << (value.is_string() ? value.get<std::string>() : text(value, -1)) << '\n';
    }
  }
}

void runInfo(const InfoArgs& args) {
  const Json json = describe(args);
  if (args.json) {
    std::cout << text(json, 2) << '\n';
  } else {
    printLines(json, "");
  }
  if (json.contains("ok") && !json["ok"].get<bool>())
    throw DataError(args.thing.string() + ": the station is damaged");
}

}  // namespace

void addInfo(CLI::App& app) {
  auto args = std::make_shared<InfoArgs>();
  CLI::App* verb = app.add_subcommand(
      "info", "Say what a file or folder is: image, mission, rig, captures, bag or station.");
  verb->add_option("THING", args->thing, "File or folder")->required();
  verb->add_flag("--verify", args->verify, "Of a station: check every tile");
  addRadiometryOptions(*verb, args->radiometry);
  addDistanceOption(*verb, args->radiometry);
  addScaleOptions(*verb, args->scale,
                  "what the file says, else its camera's, else by the range of the counts");
  verb->add_flag("--json", args->json, "Print JSON");
  verb->callback([args] { runInfo(*args); });
}

}  // namespace thermovox
