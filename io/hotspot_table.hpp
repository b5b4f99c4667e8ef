#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/hotspot_rows.hpp"

namespace thermovox {

/// What a list says. All it refers to has to outlive it.
struct HotspotList {
  const StationHotspots& found;
  const HotspotJudgement& judgement;
  std::vector<HotspotRow> rows = {};
  std::vector<AssetSurvey> surveys = {};  ///< of the last mission; empty where there are no assets
};

/// JSON with the keys of io/README.md.
[[nodiscard]] std::string hotspotsJson(const HotspotList& list);
/// The same columns; `covariance` in nine, `missions` apart by semicolons, times in Unix seconds.
void writeHotspotsCsv(const std::filesystem::path& file, const std::vector<HotspotRow>& rows,
                      Existing existing);

/// JSON of what changed between two missions (their places in the history), by the ids.
[[nodiscard]] std::string differencesJson(const StationHotspots& found, std::size_t from, std::size_t to);

}  // namespace thermovox
