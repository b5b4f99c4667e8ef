#pragma once

#include <filesystem>

#include "io/sqlite.hpp"
#include "io/station.hpp"

namespace thermovox {

/// Version of the tables below; stations of a later one are refused.
inline constexpr std::int64_t kStationSchema = 1;

/// Makes the tables of an empty station.
void createStationTables(SqlDatabase& database, const ThermalMap::Options& options);

/// Throws DataError when the database is not a station of a version that this program knows.
void checkStationTables(const SqlDatabase& database, const std::filesystem::path& path);

/// What the tables hold now.
[[nodiscard]] Station::Counts countStation(const SqlDatabase& database);
/// Writes that into `meta`, as a part of every commit ...
void recordCounts(SqlDatabase& database);
/// ... so that lost rows are noticed: throws DataError when the tables hold anything else.
void checkCounts(const SqlDatabase& database, const std::filesystem::path& path);

/// The map's options as the station has them. Throws DataError when they are missing or impossible.
[[nodiscard]] ThermalMap::Options readStationOptions(const SqlDatabase& database,
                                                     const std::filesystem::path& path);

}  // namespace thermovox
