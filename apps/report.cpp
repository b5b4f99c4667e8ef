#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/hotspot_options.hpp"
#include "apps/verbs.hpp"
#include "io/hotspot_report.hpp"
#include "io/mission_folder.hpp"
#include "io/report_pdf.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct ReportArgs {
  fs::path station;
  fs::path out;
  HotspotArgs search;
  std::string title;
  std::vector<fs::path> images;
  bool force = false;
};

/// When the last mission was mapped: a report says nothing of the clock.
std::int64_t dateOf(const StationHotspots& found) {
  std::int64_t date = 0;
  for (const MissionRecord& mission : found.missions) date = std::max(date, mission.mapped_at);
  return date;
}

/// Out of the missions' folders; each once.
SpotImagesById imagesFrom(const std::vector<fs::path>& folders, const StationHotspots& found) {
  MissionOptions options;
  options.warn = [](const std::string& warning) { spdlog::warn("{}", warning); };
  std::set<std::string> names;
  SpotImagesById images;
  for (const fs::path& folder : folders) {
    OpenedMission opened = openMission(folder, options);
    if (!names.insert(opened.mission.name).second) {
      throw UsageError("--images: found mission " + opened.mission.name + " twice, expected it once");
    }
    images.merge(cutSpotImages(found, opened));
  }
  return images;
}

void runReport(const ReportArgs& args) {
  checkEnding(args.out, {".html", ".pdf"});
  const Existing existing = args.force ? Existing::replace : Existing::refuse;
  checkOutput(args.out, existing);
  const bool pdf = endingOf(args.out) == ".pdf";
  const fs::path browser = pdf ? findBrowser() : fs::path();
  const HotspotCriteria criteria = criteriaFrom(args.search);
  HotspotJudgement judgement = judgementFrom(args.search);
  const Station station = Station::open(args.station);
  const StationHotspots found = stationHotspots(station, criteria);
  warnOfMissingLayers(found, args.station);
  const ThermalMap map = station.loadMap();
  const std::string html = hotspotReportHtml(
      {.title = args.title.empty() ? "Hot spots of " + args.station.stem().string() : args.title,
       .station = args.station.filename().string(),
       .version = THERMOVOX_VERSION,
       .criteria = criteria,
       .judgement = std::move(judgement),
       .found = found,
       .map = map,
       .images = imagesFrom(args.images, found)});
  if (pdf) {
    writePdf(args.out, html, {.browser = browser, .date = dateOf(found)}, existing);
  } else {
    AtomicFile file(args.out, existing);
    file.write(html);
    file.commit();
  }
  std::cout << args.out.string() << ": " << found.history.tracks().size() << " hot spots in "
            << found.missions.size() << " mission(s)\n";
}

}  // namespace

void addReport(CLI::App& app) {
  auto args = std::make_shared<ReportArgs>();
  CLI::App* verb = app.add_subcommand("report",
                                      "Write the inspection report of a station: conditions, map, list, a "
                                      "page for each hot spot with its position, "
                                      "values and history, assets, and how each number was made.");
  verb->add_option("STATION", args->station, "Station (.tvx)")->required();
  verb->add_option(
          "OUT", args->out,
          "Report: .html, one file that needs nothing beside it, or .pdf (A4; printed by Chromium, which "
          "has to be installed)")
      ->required();
  addHotspotOptions(*verb, args->search);
  verb->add_option("--title", args->title,
                   "Title on the cover (default: \"Hot spots of\" and the station's name)");
  verb->add_option(
          "--images", args->images,
          "Folder of a mission that is in the station; once for each mission. The pages then show each "
          "hot spot as the cameras saw it: in the thermal frame with the best view and in the visible "
          "picture nearest to that in time (a station keeps no images)")
      ->type_name("MISSION")
      ->allow_extra_args(false);
  verb->add_flag("--force", args->force, "Replace OUT when it is there");
  verb->callback([args] { runReport(*args); });
}

}  // namespace thermovox
