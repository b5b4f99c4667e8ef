#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "apps/arguments.hpp"
#include "apps/hotspot_options.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
#include "io/hotspot_table.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct HotspotsArgs {
  fs::path station;
  HotspotArgs search;
  fs::path csv;
  bool json = false;
  bool force = false;
};

void printTable(const std::vector<HotspotRow>& rows, const StationHotspots& found) {
  if (rows.empty()) {
    std::size_t cells = 0;
    for (const auto& layer : found.layers) cells += layer->samples().size();
    std::cout << "no hot spots among the " << cells << " cells that have a temperature in "
              << found.missions.size() << " mission(s)\n";
    return;
  }
  std::cout << "  id    peak C      over C  over air C      x m      y m      z m   +- mm  state         "
               "severity\n";
  for (const HotspotRow& row : rows) {
    const Hotspot& spot = *row.spot;
    const Eigen::Vector3d& p = spot.position.p_world;
    const double error = 1e3 * std::sqrt(spot.position.covariance().trace());
    std::cout << fmt::format(
        "{:4} {:6.1f}{} +-{:4.1f} {:6.1f} {:11.1f} {:8.3f} {:8.3f} {:8.3f} {:7.1f}  {:13} {}{}\n", row.id,
        spot.peak.value, spot.readsLow() ? '<' : ' ', spot.peakSigma(), spot.delta.value,
        spot.peak.value - row.ambient, p.x(), p.y(), p.z(), error, nameOf(row.change.state), row.severity,
        row.asset.empty() ? "" : "  " + row.asset);
  }
}

void runHotspots(HotspotsArgs& args) {
  const Existing existing = args.force ? Existing::replace : Existing::refuse;
  if (!args.csv.empty()) {
    checkEnding(args.csv, {".csv"});
    checkOutput(args.csv, existing);
  }
  const HotspotJudgement judgement = judgementFrom(args.search);
  const Station station = Station::open(args.station);
  const StationHotspots found = stationHotspots(station, criteriaFrom(args.search));
  warnOfMissingLayers(found, args.station);
  HotspotList list{found, judgement, hotspotRows(found, judgement)};
  if (!args.csv.empty()) writeHotspotsCsv(args.csv, list.rows, existing);
  if (args.json) {
    if (judgement.assets.size() > 0 && !found.missions.empty()) {
      list.surveys = surveyMission(found, station.loadMap(), judgement, found.missions.size() - 1);
    }
    std::cout << hotspotsJson(list);
  } else {
    printTable(list.rows, found);
  }
}

}  // namespace

void addHotspots(CLI::App& app) {
  auto args = std::make_shared<HotspotsArgs>();
  CLI::App* verb = app.add_subcommand(
      "hotspots",
      "Find the hot spots of a station, mission by mission, and follow them: where, how hot, how sure, what "
      "became of them. The hottest first; '<' marks peaks that read low (under 3 x 3 pixels, or too "
      "blurred).");
  verb->add_option("STATION", args->station, "Station (.tvx)")->required();
  addHotspotOptions(*verb, args->search);
  verb->add_option("--csv", args->csv, "Write the list as a table, too (.csv)");
  verb->add_flag("--json", args->json, "Print the list as one JSON object");
  verb->add_flag("--force", args->force, "Replace the table when it is there");
  verb->callback([args] { runHotspots(*args); });
}

}  // namespace thermovox
