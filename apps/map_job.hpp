#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "apps/map_report.hpp"
#include "io/atomic_file.hpp"
#include "io/points_record.hpp"
#include "io/station.hpp"
#include "mapping/mission_mapper.hpp"
#include "projection/radiometric_overrides.hpp"

namespace thermovox {

/// What `thermovox map` was asked to do.
struct MapJob {
  std::vector<std::filesystem::path> missions;
  std::vector<std::filesystem::path> geometry;  ///< clouds to import first
  std::filesystem::path station;
  std::optional<double> resolution;  ///< of a new station, metres
  std::filesystem::path points;      ///< the record; empty for none
  RecordedPoints recorded = RecordedPoints::coloured;
  Existing existing_points = Existing::refuse;
  double max_gap = toSeconds(Trajectory::kDefaultMaxGap);
  RadiometricOverrides radiometry;  ///< instead of what radiometric frames and their missions say
  MissionMapper::Options mapper;
  int threads = 0;                 ///< 0: one for each processor
  std::uint64_t memory_bytes = 0;  ///< of the maps, beyond which tiles go to files
  bool two_pass = false;
  bool paint = false;  ///< implies two passes
  KnownMission known = KnownMission::refuse;
  std::int64_t mapped_at = 0;  ///< Unix seconds
};

/// Of a new station.
[[nodiscard]] ThermalMap::Options newStationOptions(const MapJob& job);

/// Imports the clouds and maps all missions, and only then puts them into the station, all at once: whatever
/// fails on the way leaves the station as it was. Fills in the station's name where it is empty. The account
/// is without the time it took.
[[nodiscard]] MapResult run(MapJob& job);

}  // namespace thermovox
