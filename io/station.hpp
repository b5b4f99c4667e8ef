#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/sqlite.hpp"
#include "io/station_file.hpp"
#include "mapping/mission_report.hpp"
#include "mapping/shared_errors.hpp"
#include "mapping/thermal_map.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// What a station knows of a mission that went into it.
struct MissionRecord {
  std::string name;
  std::string rig;         ///< text of the rig.yaml
  std::string parameters;  ///< of the mapping, as the caller spells them
  std::int64_t readings = 0;
  std::int64_t points = 0;    ///< returns that entered the map
  std::int64_t coloured = 0;  ///< of them with a temperature
  std::optional<Time> first;  ///< of the points
  std::optional<Time> last;
  std::string version;                  ///< of thermovox
  std::int64_t mapped_at = 0;           ///< when it was mapped, Unix seconds
  std::optional<Pose> T_world_mission;  ///< by which a merge has moved it; none as it was mapped
  std::optional<double> ambient;        ///< of the air, C, as the mission says
  PoseSigmas pose_sigmas;
  std::vector<SharedMotion> shared_motions;  ///< how shared errors move what it mapped
  std::vector<FramePose> frame_poses;        ///< where its frames were taken
};

/// What to do with a mission whose name the station has already.
enum class KnownMission { refuse, add_again };

/// How a station is worked with.
struct StationAccess {
  int threads = 0;  ///< that pack and unpack tiles; 0: one for each processor
  /// How long addMissions waits for another process that writes the station, and what it calls when it begins
  /// to.
  StationPatience patience{};
};

/// The persistent thermal map of a place: one SQLite file with the map in compressed, checksummed tiles and
/// every mission that went into it. The file is never changed: what adds to a station writes a new file
/// beside it and puts that into its place in one step. So a mission is in the station wholly or not at all
/// whatever happens on the way, nothing ever lies beside a station but what a writer is at, and who reads one
/// reads it as it was when it was opened. The bytes depend on the missions alone, not on the order in which
/// they came. All functions throw DataError naming the file when it cannot be read or written, is damaged, or
/// is no station.
class Station {
 public:
  /// What the station holds, as it counted when it was written.
  struct Counts {
    std::int64_t missions = 0;
    std::int64_t tiles = 0;
    std::int64_t blocks = 0;
    std::int64_t surfaces = 0;     ///< cells that hold a surface
    std::int64_t layer_tiles = 0;  ///< of the missions' own temperatures
    friend bool operator==(const Counts&, const Counts&) = default;
  };

  /// An existing station, for reading at first: needs no right to write and leaves nothing behind. Reads
  /// stations of every version but those of a newer program.
  [[nodiscard]] static Station open(const std::filesystem::path& path, StationAccess access = {});
  /// A new station. Nothing is there under its name until the first mission is in. Throws DataError when the
  /// name is taken or nothing can be written in its folder.
  [[nodiscard]] static Station create(const std::filesystem::path& path, const ThermalMap::Options& options,
                                      StationAccess access = {});
  /// Throws DataError when a station could not be written under this name, be it there or not. For verbs that
  /// work for minutes before they write: ask first.
  static void checkWritable(const std::filesystem::path& path);

  Station(Station&&) noexcept;
  Station& operator=(Station&&) noexcept;
  ~Station();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Resolution and occupancy model of the map.
  [[nodiscard]] const ThermalMap::Options& options() const { return options_; }
  [[nodiscard]] Counts counts() const;
  /// In the order of their flights: by first stamp, then name.
  [[nodiscard]] std::vector<MissionRecord> missions() const;
  [[nodiscard]] ThermalMap loadMap() const;
  /// The same into a map without content, which may have a limit of its memory. Throws ConfigError when it
  /// has other options.
  void loadInto(ThermalMap& map) const;
  /// The surfaces to which one mission alone gave a temperature, with no occupancy; `place` counts in the
  /// order of missions(). None where the station keeps none: those of version 3 and before, and what a newer
  /// program has taken from them.
  [[nodiscard]] std::optional<ThermalMap> loadLayer(std::size_t place) const;

  /// Throws DataError naming mission and station when it has a mission of that name. For verbs that work for
  /// minutes before they write: ask first.
  void checkNew(const std::string& mission) const;
  /// A mission to add; the map must live until it is.
  struct Addition {
    MissionRecord record;
    const ThermalMap* map = nullptr;
  };
  /// Adds the missions' maps to that of the station and records the missions, all or none. Reads again what
  /// others have added since the station was opened; a new station whose name was taken meanwhile is
  /// continued. An older version becomes the present one. Throws ConfigError when a map has other options
  /// than the station.
  void addMissions(std::span<const Addition> additions, KnownMission known);
  void addMission(const MissionRecord& record, const ThermalMap& mission_map, KnownMission known);

  /// Reads everything: the faults found, one sentence each; none when the station is sound.
  [[nodiscard]] std::vector<std::string> verify() const;

 private:
  Station(std::filesystem::path path, const ThermalMap::Options& options, StationAccess access);
  void read();

  std::filesystem::path path_;
  ThermalMap::Options options_;
  StationAccess access_;
  std::unique_ptr<SqlDatabase> database_;  ///< null while nothing is there
};

}  // namespace thermovox
