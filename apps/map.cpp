#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "apps/arguments.hpp"
#include "apps/map_job.hpp"
#include "apps/radiometry_options.hpp"
#include "apps/verbs.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

const std::map<std::string, Carving> kCarvings{{nameOf(Carving::careful), Carving::careful},
                                               {nameOf(Carving::octomap), Carving::octomap},
                                               {nameOf(Carving::none), Carving::none}};

constexpr double kLongestGap = 1e7;  // seconds

struct MapArgs {
  MapJob job;
  bool json = false;
};

/// Unix seconds of now, or SOURCE_DATE_EPOCH where it is set, so that the same input gives the same bytes.
std::int64_t mappingTime() {
  const char* fixed = std::getenv("SOURCE_DATE_EPOCH");
  if (fixed == nullptr) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::seconds>(now).count();
  }
  const std::string_view text = fixed;
  std::int64_t seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || seconds < 0) {
    throw ConfigError("SOURCE_DATE_EPOCH: found '" + std::string(text) + "', expected whole Unix seconds");
  }
  return seconds;
}

void checkUsage(const MapJob& job) {
  if (job.missions.empty() && job.geometry.empty()) {
    throw UsageError("map: found neither a MISSION nor --geometry, expected at least one of them");
  }
  if (!(job.max_gap > 0.0 && job.max_gap <= kLongestGap)) {
    throw UsageError("--max-gap: found " + std::to_string(job.max_gap) +
                     " s, expected more than 0 and at most " + std::to_string(kLongestGap) + " s");
  }
  checkRadiometry(job.radiometry);
  if (!job.points.empty()) checkEnding(job.points, {".csv", ".ply"});
  for (const std::filesystem::path& file : job.geometry) checkEnding(file, {".pcd", ".ply"});
  try {
    newStationOptions(job).validate();
  } catch (const ConfigError& error) {
    throw UsageError(std::string("--resolution: ") + error.what());
  }
}

void runMap(MapArgs& args) {
  const auto begin = std::chrono::steady_clock::now();
  checkUsage(args.job);
  args.job.mapped_at = mappingTime();
  MapResult result = run(args.job);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (args.json) {
    printJson(result);
  } else {
    printText(result, args.job.station);
  }
}

/// How the work is done, and in how many looks.
void addWorkOptions(CLI::App& verb, const std::shared_ptr<MapArgs>& args) {
  addThreadsOption(verb, args->job.threads);
  addMemoryOption(verb, args->job.memory_bytes,
                  "Memory that the maps may take [MB]; tiles beyond it wait in a file beside the station, "
                  "which is slower");
  verb.add_flag("--two-pass", args->job.two_pass,
                "Read each mission twice: geometry first, then colours, tested against all of it");
  verb.add_flag(
      "--paint", args->job.paint,
      "Two passes, and every thermal frame colours all the surface that it sees: of its mission, of "
      "the station as it is, of imported clouds");
}

}  // namespace

void addMap(CLI::App& app) {
  auto args = std::make_shared<MapArgs>();
  CLI::App* verb = app.add_subcommand(
      "map",
      "Colour every laser point of a mission with its temperature and integrate it into a station's map.");
  verb->add_option("MISSION", args->job.missions, "Mission folders");
  verb->add_option("--geometry", args->job.geometry,
                   "Clouds (.ply or .pcd; world frame, metres) whose surfaces enter the station before the "
                   "missions, and hide things from their cameras");
  verb->add_option(
      "--station", args->job.station,
      "Station to write or to continue (default: NAME.tvx of the first mission in the current folder)");
  verb->add_option("--resolution", args->job.resolution,
                   "Edge of a cell of a new station [m] (default 0.05)");
  verb->add_option("--points", args->job.points,
                   "Record of every coloured point, in time order (.csv or .ply)");
  verb->add_flag_callback(
      "--all-points", [args] { args->job.recorded = RecordedPoints::all; },
      "Record the points without temperature too, with empty fields");
  addChoice(*verb, "--carve", args->job.mapper.carving, kCarvings,
            "Which cells a ray frees: octomap (all before its return, as OctoMap does), careful (of these no "
            "cell that a return of the mission hit, and none beside a hit of the same sweep), or none "
            "(default careful)");
  verb->add_option("--max-gap", args->job.max_gap, "Longest time without poses that is interpolated [s]")
      ->capture_default_str();
  verb->add_flag_callback(
      "--again", [args] { args->job.known = KnownMission::add_again; },
      "Integrate a mission although the station has one of that name");
  addRadiometryOptions(*verb, args->job.radiometry);
  addWorkOptions(*verb, args);
  verb->add_flag_callback(
      "--force", [args] { args->job.existing_points = Existing::replace; },
      "Replace a points record that is there");
  verb->add_flag("--json", args->json, "Print the account as JSON");
  verb->callback([args] { runMap(*args); });
}

}  // namespace thermovox
