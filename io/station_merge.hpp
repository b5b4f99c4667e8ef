#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>

#include "io/atomic_file.hpp"
#include "io/station.hpp"
#include "io/station_file.hpp"

namespace thermovox {

/// A station that goes into another.
struct MergeInput {
  std::filesystem::path station;
  /// Takes its coordinates to those of the result; none where they are the same, which is exact. A motion
  /// resamples the map (see addMoved) and is recorded with its missions.
  std::optional<Pose> T_world_station;
};

/// How a merge works.
struct MergeWork {
  int threads = 0;  ///< 0: one for each processor
  /// That the stations which are moved may take in memory, bytes; beyond it tiles wait in files beside the
  /// output. The result does not depend on it.
  std::uint64_t memory_bytes = std::numeric_limits<std::uint64_t>::max();
  /// With other processes that write the station which is replaced.
  StationPatience patience{};
};

/// Writes one station of several, which stay as they are. Without motions the result is, to the byte, that of
/// mapping all the missions into one station, in whatever order. Throws DataError naming the stations when a
/// mission is in two of them, or when the output is one of them; ConfigError when their cells, occupancy
/// models or frames differ. A station that is replaced is locked meanwhile, as by whoever adds a mission.
Station::Counts mergeStations(std::span<const MergeInput> inputs, const std::filesystem::path& output,
                              Existing existing, const MergeWork& work = {});

}  // namespace thermovox
