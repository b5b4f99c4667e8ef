#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
#include "io/station_merge.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct MergeArgs {
  std::vector<fs::path> stations;
  std::vector<std::string> transforms;
  fs::path out;
  MergeWork work;
  bool force = false;
  bool json = false;
};

/// `POSE` moves every station but the first, `STATION=POSE` the one of that name.
void applyTransform(const std::string& transform, std::vector<MergeInput>& inputs) {
  const std::size_t sign = transform.find('=');
  const Pose pose =
      poseFrom(sign == std::string::npos ? transform : transform.substr(sign + 1), "--transform");
  const fs::path named = sign == std::string::npos ? "" : transform.substr(0, sign);
  bool applied = false;
  for (std::size_t i = named.empty() ? 1 : 0; i < inputs.size(); ++i) {
    if (!named.empty() && inputs[i].station != named) continue;
    inputs[i].T_world_station = pose;
    applied = true;
  }
  if (!applied)
    throw UsageError("--transform: found '" + transform + "', expected the name of one of the stations");
}

std::vector<MergeInput> inputsFrom(const MergeArgs& args) {
  std::vector<MergeInput> inputs;
  for (const fs::path& station : args.stations) inputs.push_back({station, std::nullopt});
  for (const std::string& transform : args.transforms) applyTransform(transform, inputs);
  return inputs;
}

void runMerge(const MergeArgs& args) {
  if (args.stations.size() < 2) throw UsageError("merge: found one station, expected two or more");
  const std::vector<MergeInput> inputs = inputsFrom(args);
  const Existing existing = args.force ? Existing::replace : Existing::refuse;
  MergeWork work = args.work;
  work.patience.begins = [&args] {
    spdlog::info("{}: waits for another process that is writing it", args.out.string());
  };
  const Station::Counts counts = mergeStations(inputs, args.out, existing, work);
  if (args.json) {
    const nlohmann::ordered_json json{{"station", args.out.string()},
                                      {"stations", args.stations.size()},
                                      {"missions", counts.missions},
                                      {"tiles", counts.tiles},
                                      {"voxels", counts.surfaces}};
    std::cout << json.dump(2) << '\n';
  } else {
    std::cout << args.out.string() << ": " << counts.missions << " missions of " << args.stations.size()
              << " stations, " << counts.surfaces << " cells that hold a surface\n";
  }
}

}  // namespace

void addMerge(CLI::App& app) {
  auto args = std::make_shared<MergeArgs>();
  CLI::App* verb = app.add_subcommand(
      "merge",
      "Write one station of several, which stay as they are. The order makes no difference: the result is, "
      "to the byte, that of mapping all their missions into one station. Refused: a mission that is in two "
      "of them, other cells, another occupancy model.");
  verb->add_option("STATION", args->stations, "Stations (.tvx), two or more")->required();
  verb->add_option("-o,--output", args->out, "Station to write, none of those")->required();
  verb->add_option(
          "--transform", args->transforms,
          "Moves a station into the frame of the result: [STATION=]POSE, where POSE is "
          "\"tx ty tz qx qy qz qw\" [m, unit quaternion] or a file that holds it; without STATION= every "
          "station but the first. That resamples: surfaces go with their statistics to the cell of their "
          "mean place, log-odds to the cell in which their centre falls, so that shapes shift by up to half "
          "a cell's diagonal, and bytes depend on which station was moved. Recorded with the missions")
      ->type_name("[STATION=]POSE")
      ->allow_extra_args(false);
  addThreadsOption(*verb, args->work.threads);
  addMemoryOption(
      *verb, args->work.memory_bytes,
      "Memory that stations which --transform moves may take [MB]; tiles beyond it wait in a file "
      "beside the output, which is slower. Others are read tile by tile");
  verb->add_flag("--force", args->force,
                 "Replace the output when it is there; who writes it is waited for, up to 30 s");
  verb->add_flag("--json", args->json, "Print the account as JSON");
  verb->callback([args] { runMerge(*args); });
}

}  // namespace thermovox
