#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "io/hotspot_table.hpp"

namespace thermovox {

/// What the verbs about hot spots are asked alike.
struct HotspotArgs {
  std::optional<double> above;
  std::optional<double> delta;
  std::optional<double> ambient;
  std::filesystem::path severity;
  std::filesystem::path assets;
  std::optional<double> assumed_emissivity;
};

void addHotspotOptions(CLI::App& verb, HotspotArgs& args);

/// With neither temperature nor difference: a difference of 10 C. Throws UsageError for what cannot be.
[[nodiscard]] HotspotCriteria criteriaFrom(const HotspotArgs& args);
/// Reads the files that were named.
[[nodiscard]] HotspotJudgement judgementFrom(const HotspotArgs& args);

/// Missions whose own temperatures the station does not have are not in the result.
void warnOfMissingLayers(const StationHotspots& found, const std::filesystem::path& station);

}  // namespace thermovox
