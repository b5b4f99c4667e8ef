#pragma once

#include <filesystem>
#include <vector>

namespace thermovox::bench {

/// A map after so many scans.
struct GrowthPoint {
  int scans = 0;
  double cpu_ms = 0.0;       ///< processor time of the last scan alone
  double total_cpu_s = 0.0;  ///< and of all so far
  double memory_mb = 0.0;    ///< the process's resident memory less that without the map
};

/// How closely the total time lies on a straight line through the first scan's beginning.
struct Linearity {
  double seconds_a_scan = 0.0;  ///< slope by least squares
  double worst = 0.0;           ///< largest distance from the line over the total time
  double last_to_first = 0.0;   ///< mean cost of a scan in the last quarter over that in the first
};
/// Precondition: at least four points.
[[nodiscard]] Linearity linearity(const std::vector<GrowthPoint>& curve);

/// Writes the curve as CSV. Throws DataError naming the file.
void writeGrowthCsv(const std::filesystem::path& path, const std::vector<GrowthPoint>& curve);
/// Draws total time (with the line) and memory over the scans, as PNG. Throws DataError naming the file.
void writeGrowthPicture(const std::filesystem::path& path, const std::vector<GrowthPoint>& curve);

}  // namespace thermovox::bench
