#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/station_hotspots.hpp"
#include "mapping/assets.hpp"
#include "mapping/severity.hpp"

namespace thermovox {

/// How hot spots are judged.
struct HotspotJudgement {
  SeverityTable table = netaSeverity();
  std::optional<double> ambient;  ///< of the air, C; else the mission's, else its layer's median
  Assets assets;
};

/// A row of the list: a hot spot as the last mission that saw it has it.
struct HotspotRow {
  int id = 0;
  const Hotspot* spot = nullptr;
  HotspotChange change;  ///< of the last mission of all, against the last one before it that saw it
  double ambient = 0.0;  ///< C, what the severity is counted from
  std::string severity;  ///< of the rise over ambient; empty where there is none
  std::string action;    ///< what to do, in the table's words
  std::string asset;     ///< empty where it belongs to none
  Time first_seen;       ///< by any mission
  Time last_seen;
  std::vector<std::string> missions;  ///< that saw it
};

/// Of all hot spots, the hottest first. `found` has to live on.
[[nodiscard]] std::vector<HotspotRow> hotspotRows(const StationHotspots& found,
                                                  const HotspotJudgement& judgement);

/// What a mission's rises are counted from, C.
[[nodiscard]] double ambientOf(const StationHotspots& found, std::size_t mission,
                               const std::optional<double>& asked);

/// JSON with the keys of io/README.md.
[[nodiscard]] std::string hotspotsJson(const std::vector<HotspotRow>& rows);
/// The same columns; `covariance` in nine, `missions` apart by semicolons, times in Unix seconds.
void writeHotspotsCsv(const std::filesystem::path& file, const std::vector<HotspotRow>& rows,
                      Existing existing);

/// JSON of what changed between two missions (their places in the history), by the ids.
[[nodiscard]] std::string differencesJson(const StationHotspots& found, std::size_t from, std::size_t to);

}  // namespace thermovox
