#pragma once

#include <filesystem>

#include "io/sqlite.hpp"
#include "io/station.hpp"

namespace thermovox {

/// Version of what this program writes. Older ones are read as they are, and become of this one when a
/// mission is added; later ones are refused. Version 3 kept no layers, that is each mission's own
/// temperatures, and not what it declares of its errors; version 2 had besides surface cells without a common
/// sigma; version 1 had other ones altogether (tile_layout_1.hpp) and no column T_world_mission.
inline constexpr std::int64_t kStationSchema = 4;

/// Makes the empty tables of a station. What goes into a station is written in one order: missions, tiles,
/// meta.
void createStationTables(SqlDatabase& database);
/// Whether the station keeps a mission's own temperatures.
enum class HasLayer { no, yes };
void insertMission(SqlDatabase& database, const MissionRecord& record, HasLayer has_layer);
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

/// By the mission's id, which is its place among them from 1 on.
[[nodiscard]] bool hasLayer(const SqlDatabase& database, std::int64_t mission_id);

/// What the station says of its frame.
[[nodiscard]] std::string readStationFrame(const SqlDatabase& database, const std::filesystem::path& path);

/// The map's options as the station has them. Throws DataError when they are missing or impossible.
[[nodiscard]] ThermalMap::Options readStationOptions(const SqlDatabase& database,
                                                     const std::filesystem::path& path);

}  // namespace thermovox
