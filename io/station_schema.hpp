#pragma once

#include <filesystem>

#include "io/sqlite.hpp"
#include "io/station.hpp"

namespace thermovox {

/// Version of what this program writes. Older ones are read as they are, and become of this one when a
/// mission is added; later ones are refused. Version 2 had surface cells without a common sigma;
/// version 1 had other ones altogether (tile_layout_1.hpp) and no column T_world_mission.
inline constexpr std::int64_t kStationSchema = 3;

/// Makes the empty tables of a station. What goes into a station is written in one order: missions, tiles,
/// meta.
void createStationTables(SqlDatabase& database);
void insertMission(SqlDatabase& database, const MissionRecord& record);
/// The options, and what the tables hold now.
void writeStationMeta(SqlDatabase& database, const ThermalMap::Options& options);

/// Throws DataError when the database is not a station of a version that this program knows.
void checkStationTables(const SqlDatabase& database, const std::filesystem::path& path);
[[nodiscard]] std::int64_t stationVersion(const SqlDatabase& database);

/// What the tables hold now.
[[nodiscard]] Station::Counts countStation(const SqlDatabase& database);
/// Lost rows are noticed: throws DataError when the tables hold anything else than was written.
void checkCounts(const SqlDatabase& database, const std::filesystem::path& path);
/// In the order in which they lie there.
[[nodiscard]] std::vector<MissionRecord> readMissions(const SqlDatabase& database,
                                                      const std::filesystem::path& path);

/// What the station says of its frame.
[[nodiscard]] std::string readStationFrame(const SqlDatabase& database, const std::filesystem::path& path);

/// The map's options as the station has them. Throws DataError when they are missing or impossible.
[[nodiscard]] ThermalMap::Options readStationOptions(const SqlDatabase& database,
                                                     const std::filesystem::path& path);

}  // namespace thermovox
