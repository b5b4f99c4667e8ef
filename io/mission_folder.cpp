#include "io/mission_folder.hpp"

#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

#include "io/description_file.hpp"
#include "io/frame_source.hpp"
#include "io/input_file.hpp"
#include "io/laser_sources.hpp"
#include "io/number_text.hpp"
#include "io/rig_file.hpp"
#include "io/tum_trajectory.hpp"
#include "io/yaml_map.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestMissionFile = std::size_t{1} << 20;  // bytes; it has a few lines

double notNegative(const YamlMap& map, std::string_view key) {
  const double number = map.numberIf(key).value_or(0.0);
  if (number < 0.0) throw ConfigError(map.place(key) + ": is " + exactText(number) + ", expected 0 or more");
  return number;
}

Duration cameraTimeOffset(const YamlMap& map) {
  constexpr double kLargest = 4e9;  // seconds; a clock that starts at 1970 is off by half as much
  const double seconds = map.numberIf("camera_time_offset").value_or(0.0);
  if (std::abs(seconds) > kLargest) {
    throw ConfigError(map.place("camera_time_offset") + ": is " + exactText(seconds) +
                      " s, expected at most 4e9 s");
  }
  return durationFromSeconds(seconds);
}

/// Also checks the temperature of the air, which is said under its own key.
RadiometricOverrides radiometry(const YamlMap& map, const std::optional<double>& ambient) {
  RadiometricOverrides overrides;
  overrides.emissivity = map.numberIf("emissivity");
  overrides.reflected = map.numberIf("reflected");
  overrides.humidity = map.numberIf("humidity");
  try {
    overrides.orElse({.atmosphere_temperature = ambient}).validate();
  } catch (const ConfigError& error) {
    throw ConfigError(map.place("") + ": " + error.what());
  }
  return overrides;
}

class MissionOpener {
 public:
  MissionOpener(const fs::path& file, const MissionOptions& options)
      : name_(file.string()), folder_(file.parent_path()), options_(options) {
    file_ = parseMissionFile(readWhole(file, "", kLargestMissionFile), name_);
  }

  OpenedMission open() const {
    OpenedMission opened{
        .mission = mission(), .file = name_, .folder = folder_, .rig_file = folder_ / file_.rig};
    opened.readings = readings(opened.mission.rig);
    if (file_.thermal) opened.thermal_list = wanted(*file_.thermal, "thermal");
    if (opened.mission.rig.thermal_camera && opened.thermal_list) {
      opened.frames = readFrames({.list = *opened.thermal_list,
                                  .folder = folder_,
                                  .time_offset = file_.camera_time_offset,
                                  .radiometry = options_.radiometry.orElse(file_.radiometry),
                                  .ambient = file_.ambient,
                                  .warn = options_.warn},
                                 *opened.mission.rig.thermal_camera);
    }
    if (file_.visible) opened.visible_list = wanted(*file_.visible, "visible");
    return opened;
  }

 private:
  Mission mission() const {
    Mission mission{.name = file_.name, .rig = readRig(wanted(file_.rig, "rig"))};
    mission.trajectory =
        Trajectory(readTumTrajectory(wanted(file_.trajectory, "trajectory")), options_.max_gap);
    mission.pose_rotation_sigma = file_.pose_rotation_sigma;
    mission.pose_translation_sigma = file_.pose_translation_sigma;
    mission.camera_time_offset = file_.camera_time_offset;
    mission.ambient = file_.ambient;
    return mission;
  }

  std::unique_ptr<ReadingSource> readings(const Rig& rig) const {
    if (file_.lasers.size() != rig.lasers.size()) {
      throw ConfigError(name_ + ", laser: names " + std::to_string(file_.lasers.size()) +
                        " recording(s), expected " + std::to_string(rig.lasers.size()) +
                        ", one for each laser of " + file_.rig);
    }
    std::vector<std::unique_ptr<ReadingSource>> sources;
    for (std::size_t i = 0; i < rig.lasers.size(); ++i) {
      const fs::path file = wanted(file_.lasers[i], "laser");
      sources.push_back(readLaser({folder_, file.string(), std::make_unique<std::ifstream>(openInput(file))},
                                  rig.lasers[i], i));
    }
    return std::make_unique<NotEmpty>(mergeReadings(std::move(sources)), name_);
  }

  /// A source that has proven to hold a reading.
  class NotEmpty final : public ReadingSource {
   public:
    NotEmpty(std::unique_ptr<ReadingSource> source, const std::string& mission)
        : source_(std::move(source)), first_(source_->next()) {
      if (!first_) throw DataError(mission + ": the mission is empty: its laser recorded no reading");
    }
    std::optional<Reading> next() override {
      if (first_) return std::exchange(first_, std::nullopt);
      return source_->next();
    }

   private:
    std::unique_ptr<ReadingSource> source_;
    std::optional<Reading> first_;
  };

  /// The path of a file that mission.yaml names under a key; it must be there.
  fs::path wanted(const std::string& written, std::string_view key) const {
    const fs::path file = folder_ / written;
    static_cast<void>(openInput(file, name_ + ", " + std::string(key)));
    return file;
  }

  std::string name_;
  fs::path folder_;
  MissionOptions options_;
  MissionFile file_;
};

}  // namespace

MissionFile parseMissionFile(const std::string& text, const std::string& file_name) {
  const YamlMap map = YamlMap::parse(text, file_name);
  map.allow({"name", "rig", "trajectory", "thermal", "visible", "laser", "pose_sigma", "camera_time_offset",
             "ambient", "emissivity", "reflected", "humidity"});
  MissionFile mission{
      .name = map.plainName("name"), .rig = map.text("rig"), .trajectory = map.text("trajectory")};
  mission.lasers = map.textOrList("laser");
  if (mission.lasers.empty()) throw ConfigError(map.place("laser") + ": is missing");
  mission.thermal = map.textIf("thermal");
  mission.visible = map.textIf("visible");
  if (const std::optional<YamlMap> sigma = map.mapIf("pose_sigma")) {
    sigma->allow({"rotation", "translation"});
    mission.pose_rotation_sigma = notNegative(*sigma, "rotation");
    mission.pose_translation_sigma = notNegative(*sigma, "translation");
  }
  mission.camera_time_offset = cameraTimeOffset(map);
  mission.ambient = map.numberIf("ambient");
  mission.radiometry = radiometry(map, mission.ambient);
  return mission;
}

OpenedMission openMission(const fs::path& folder, const MissionOptions& options) {
  return MissionOpener(descriptionFile(folder, "mission.yaml", "mission"), options).open();
}

}  // namespace thermovox
