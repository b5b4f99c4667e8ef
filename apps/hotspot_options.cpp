#include "apps/hotspot_options.hpp"

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

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
      "else the median of its map)");
  verb.add_option("--severity", args.severity,
                  "Table of severities (.yaml; default ANSI/NETA MTS 100.18, over ambient)")
      ->check(CLI::ExistingFile);
  verb.add_option("--assets", args.assets, "Assets of the plant (.yaml): boxes with names, limits and twins")
      ->check(CLI::ExistingFile);
}

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
