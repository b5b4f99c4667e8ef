#pragma once

#include <filesystem>

#include "io/atomic_file.hpp"
#include "io/cloud_writer.hpp"
#include "mapping/thermal_map.hpp"

namespace thermovox {

/// OctoMap's `.bt`: which cells are free and which occupied, each at its clamp. Throws DataError when the map
/// reaches beyond OctoMap's keys, and as AtomicFile does.
void writeBt(const std::filesystem::path& path, const ThermalMap& map, Existing existing);

/// OctoMap's `.ot` with a ColorOcTree: log-odds, and cells that hold a surface coloured by temperature, grey
/// where no frame saw them. Throws as writeBt.
void writeOt(const std::filesystem::path& path, const ThermalMap& map, const ColourScale& scale,
             Existing existing);

}  // namespace thermovox
