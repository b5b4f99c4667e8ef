#include "apps/hotspot_options.hpp"

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "apps/arguments.hpp"
#include "io/asset_file.hpp"
#include "io/severity_file.hpp"

namespace thermovox {

void addHotspotOptions(CLI::App& verb, HotspotArgs& args) {
  verb.add_option("--above", args.above, "What is hot: temperatures from this on [C]");
  verb.add_option(
      "--delta", args.delta,
      "What is hot: so much over the surroundings on the same surface [C] (with --above either is "
      "enough; with neither 10)");
  verb.add_option(
          "--ambient", args.ambient,
          "Temperature of the air that severities are counted from [C] (default: what the mission says, "
          "else the median of its map)")
      ->check(isFinite());
  verb.add_option("--severity", args.severity,
                  "Table of severities (.yaml; default ANSI/NETA MTS 100.18, over ambient)")
      ->check(CLI::ExistingFile);
  verb.add_option("--assets", args.assets,
                  "Assets of the plant (.yaml): boxes with names, emissivities, limits and twins")
      ->check(CLI::ExistingFile);
  verb.add_option(
      "--assumed-emissivity", args.assumed_emissivity,
      "What the cameras took all surfaces for (0.05 to 1; as delivered mostly 0.95): temperatures "
      "on assets of another emissivity are corrected for it");
}

namespace {

/// Throws UsageError for one that no surface has; says so where assets have emissivities that are not used.
std::optional<double> assumedEmissivity(const HotspotArgs& args, const Assets& assets) {
  if (const auto& emissivity = args.assumed_emissivity) {
    if (*emissivity >= 0.05 && *emissivity <= 1.0) return emissivity;
    throw UsageError(fmt::format("--assumed-emissivity: found {}, expected 0.05 to 1", *emissivity));
  }
  const auto known = std::count_if(assets.all().begin(), assets.all().end(),
                                   [](const Asset& asset) { return asset.emissivity.has_value(); });
  if (known > 0) {
    spdlog::warn(
        "{}: gives {} asset(s) an emissivity, but without --assumed-emissivity no temperature is "
        "corrected for it",
        args.assets.string(), known);
  }
  return std::nullopt;
}

}  // namespace

HotspotCriteria criteriaFrom(const HotspotArgs& args) {
  HotspotCriteria criteria{.above = args.above, .delta = args.delta};
  if (!args.above && !args.delta) criteria.delta = 10.0;
  try {
    criteria.validate();
  } catch (const ConfigError& error) {
    throw UsageError(std::string("--") + error.what());
  }
  return criteria;
}

HotspotJudgement judgementFrom(const HotspotArgs& args) {
  HotspotJudgement judgement{.ambient = args.ambient};
  if (!args.severity.empty()) judgement.table = readSeverity(args.severity);
  if (!args.assets.empty()) judgement.assets = readAssets(args.assets);
  judgement.assumed_emissivity = assumedEmissivity(args, judgement.assets);
  return judgement;
}

void warnOfMissingLayers(const StationHotspots& found, const std::filesystem::path& station) {
  if (found.without_layer.empty()) return;
  const std::string names = fmt::format("{}", fmt::join(found.without_layer, ", "));
  if (found.missions.size() == 1 && found.history.missions().front().mission.find(names) == 0) {
    spdlog::warn("{}: is of an older program, which kept only the mean of all missions: it stands for one",
                 station.string());
  } else {
    spdlog::warn("{}: has not kept the own temperatures of {} (mapped by an older program): not searched",
                 station.string(), names);
  }
}

}  // namespace thermovox
