#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "projection/mission.hpp"
#include "projection/radiometric_overrides.hpp"
#include "projection/sources.hpp"

namespace thermovox {

/// What a mission.yaml says; the files are as written, relative to its folder.
struct MissionFile {
  std::string name;
  std::string rig;
  std::string trajectory;
  std::vector<std::string> lasers;  ///< one recording for each of the rig's lasers, in its order
  std::optional<std::string> thermal;
  std::optional<std::string> visible;
  double pose_rotation_sigma = 0.0;     ///< radians
  double pose_translation_sigma = 0.0;  ///< metres
  Duration camera_time_offset = Duration::zero();
  std::optional<double> ambient;  ///< Celsius
  /// emissivity, reflected (Celsius) and humidity, instead of what radiometric frames say.
  RadiometricOverrides radiometry;
};

/// Reads the text of a mission.yaml; `file_name` stands for it in messages. Throws ConfigError naming the key
/// that is missing, unknown or impossible.
[[nodiscard]] MissionFile parseMissionFile(const std::string& text, const std::string& file_name);

/// A mission with its streams. They read as they go, one sweep and one image at a time, so that a mission of
/// any length needs no more memory than that and its trajectory.
struct OpenedMission {
  Mission mission;
  std::unique_ptr<ReadingSource> readings;  ///< of all lasers, in the order of their stamps
  /// Null when the rig has no thermal camera or the mission no thermal images.
  std::unique_ptr<FrameSource> frames;
  std::filesystem::path file;    ///< mission.yaml
  std::filesystem::path folder;  ///< of mission.yaml
  std::filesystem::path rig_file;
  std::optional<std::filesystem::path> thermal_list;  ///< also where the rig has no thermal camera
  std::optional<std::filesystem::path> visible_list;  ///< `timestamp,file` of the visible pictures
};

struct MissionOptions {
  /// The trajectory does not interpolate over a longer time without poses.
  Duration max_gap = Trajectory::kDefaultMaxGap;
  /// Instead of what radiometric frames say, and their mission. A frame's distance is that of each point.
  RadiometricOverrides radiometry;
  /// Hears, while the frames are read, what the user should know of them (FrameRecording); may be empty.
  std::function<void(const std::string&)> warn;
};

/// Opens a mission: its folder or its mission.yaml. Throws ConfigError or DataError, naming the file and who
/// refers to it, for what is missing, damaged or does not fit together, and for a mission without readings.
[[nodiscard]] OpenedMission openMission(const std::filesystem::path& folder,
                                        const MissionOptions& options = {});

}  // namespace thermovox
