#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "apps/hotspot_options.hpp"
#include "apps/verbs.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct DiffArgs {
  fs::path station;
  std::string from;
  std::string to;
  HotspotArgs search;
  bool json = false;
};

/// Place of a mission in the history; the last one of that name.
std::size_t placeOf(const StationHotspots& found, const std::string& name, const fs::path& station) {
  std::string names;
  for (std::size_t i = found.missions.size(); i-- > 0;) {
    if (found.missions[i].name == name) return i;
    names = found.missions[i].name + (names.empty() ? "" : ", ") + names;
  }
  if (names.empty())
    throw DataError(station.string() + ": has no temperatures, expected those of two missions");
  throw DataError(station.string() + ": has no temperatures of a mission '" + name + "', expected one of " +
                  names);
}

std::string celsius(const std::optional<Estimate>& estimate) {
  return estimate ? fmt::format("{:.1f}", estimate->value) : "-";
}

void printTable(const StationHotspots& found, std::size_t from, std::size_t to) {
  const auto differences = found.history.between(from, to);
  if (differences.empty()) {
    std::cout << "no hot spots in either mission\n";
    return;
  }
  std::cout
      << "  id  state          before C   after C  change C  sigmas  alarm       x m      y m      z m\n";
  for (const auto& [place, change] : differences) {
    const HotspotTrack& track = found.history.tracks()[place];
    const Eigen::Vector3d& p = (track.seen[to] ? track.seen[to] : track.seen[from])->position.p_world;
    const bool known = change.from && change.to;
    std::cout << fmt::format("{:4}  {:13} {:>9} {:>9} {:>9} {:>7}  {:5} {:9.3f}{:9.3f}{:9.3f}\n", track.id,
                             nameOf(change.state), celsius(change.from), celsius(change.to),
                             known ? fmt::format("{:+.1f}", change.change.value) : "-",
                             known ? fmt::format("{:.1f}", change.significance()) : "-",
                             change.alarm ? "ALARM" : "", p.x(), p.y(), p.z());
  }
}

void runDiff(const DiffArgs& args) {
  const StationHotspots found = stationHotspots(Station::open(args.station), criteriaFrom(args.search));
  warnOfMissingLayers(found, args.station);
  const std::size_t from = placeOf(found, args.from, args.station);
  const std::size_t to = placeOf(found, args.to, args.station);
  if (args.json) {
    std::cout << differencesJson(found, from, to);
  } else {
    printTable(found, from, to);
  }
}

}  // namespace

void addDiff(CLI::App& app) {
  auto args = std::make_shared<DiffArgs>();
  CLI::App* verb = app.add_subcommand(
      "diff",
      "What became of the hot spots from one mission to another. Compared is the rise over the surroundings, "
      "not the temperature: a warmer season changes nothing. A change counts from 2 C on, at three and a "
      "half sigmas.");
  verb->add_option("STATION", args->station, "Station (.tvx)")->required();
  verb->add_option("--from", args->from, "Name of the earlier mission")->required();
  verb->add_option("--to", args->to, "Name of the later mission")->required();
  verb->add_option("--above", args->search.above, "What is hot: temperatures from this on [C]");
  verb->add_option("--delta", args->search.delta,
                   "What is hot: so much over the surroundings [C] (default 10)");
  verb->add_flag("--json", args->json, "Print the list as one JSON object");
  verb->callback([args] { runDiff(*args); });
}

}  // namespace thermovox
