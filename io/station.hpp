#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapping/thermal_map.hpp"

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
  std::string version;         ///< of thermovox
  std::int64_t mapped_at = 0;  ///< when it was mapped, Unix seconds
};

/// What to do with a mission whose name the station has already.
enum class KnownMission { refuse, add_again };

/// The persistent thermal map of a place: one SQLite file with the map in compressed, checksummed tiles and
/// every mission that went into it. A mission is in it wholly or not at all, whatever happens on the way; a
/// closed station is one file. All functions throw DataError naming the file when it cannot be read or
/// written, is damaged, or is no station.
class Station {
 public:
  /// What the station holds, as it counted when it was written.
  struct Counts {
    std::int64_t missions = 0;
    std::int64_t tiles = 0;
    std::int64_t blocks = 0;
    std::int64_t surfaces = 0;  ///< cells that hold a surface
    friend bool operator==(const Counts&, const Counts&) = default;
  };

  /// An existing station; works from a read-only folder too. Refuses one of a newer version of the program.
  [[nodiscard]] static Station open(const std::filesystem::path& path);
  /// A new station. Nothing is there under its name until the first mission is in: it is built beside it.
  /// What killed processes left of such files is removed. Throws DataError when the name is taken or its
  /// folder does not exist.
  [[nodiscard]] static Station create(const std::filesystem::path& path, const ThermalMap::Options& options);

  Station(Station&&) noexcept;
  Station& operator=(Station&&) noexcept;
  ~Station();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Resolution and occupancy model of the map.
  [[nodiscard]] const ThermalMap::Options& options() const { return options_; }
  [[nodiscard]] Counts counts() const;
  /// In the order in which they were added.
  [[nodiscard]] std::vector<MissionRecord> missions() const;
  [[nodiscard]] ThermalMap loadMap() const;

  /// Throws DataError naming mission and station when it has a mission of that name. For verbs that work for
  /// minutes before they write: ask first.
  void checkNew(const std::string& mission) const;
  /// A mission to add; the map must live until it is.
  struct Addition {
    MissionRecord record;
    const ThermalMap* map = nullptr;
  };
  /// Merges the missions' maps into the stored tiles and records the missions, all or none, in one
  /// transaction. Throws ConfigError when a map has other options than the station.
  void addMissions(std::span<const Addition> additions, KnownMission known);
  void addMission(const MissionRecord& record, const ThermalMap& mission_map, KnownMission known);

  /// Reads everything: the faults found, one sentence each; none when the station is sound.
  [[nodiscard]] std::vector<std::string> verify() const;

 private:
  struct Storage;
  Station(std::filesystem::path path, ThermalMap::Options options, std::unique_ptr<Storage> storage);
  void finishCreation();

  std::filesystem::path path_;
  ThermalMap::Options options_;
  std::unique_ptr<Storage> storage_;
};

}  // namespace thermovox
