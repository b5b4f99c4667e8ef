#pragma once

#include <filesystem>
#include <string>

#include "io/station.hpp"
#include "mapping/thermal_map.hpp"

namespace thermovox {

/// The name under which a station knows an imported cloud: the file's, without its ending.
[[nodiscard]] std::string cloudName(const std::filesystem::path& file);

/// Reads a PCD or PLY file in world coordinates (metres) into an empty map, and says what a station is to
/// remember of it. Throws DataError naming the file.
[[nodiscard]] MissionRecord importCloud(const std::filesystem::path& file, ThermalMap& map);

}  // namespace thermovox
