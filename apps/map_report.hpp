#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "mapping/mission_report.hpp"

namespace thermovox {

/// The account of a run of map.
struct MapResult {
  std::vector<MissionReport> missions;
  std::size_t voxels = 0;
  std::size_t spilled_tiles = 0;  ///< how often a tile did not fit into memory
  double seconds = 0.0;

  [[nodiscard]] double pointsPerSecond() const {
    std::size_t points = 0;
    for (const MissionReport& mission : missions) points += mission.points;
    return seconds > 0.0 ? static_cast<double>(points) / seconds : 0.0;
  }
};

/// Says on standard error how many points have temperatures that their camera is not calibrated for, if any.
void warnOfCalibration(const MissionReport& report);

/// As one JSON object, or as text for a person; both on standard output.
void printJson(const MapResult& result);
void printText(const MapResult& result, const std::filesystem::path& station);

}  // namespace thermovox
