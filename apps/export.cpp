#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
#include "io/cloud_writer.hpp"
#include "io/folders.hpp"
#include "io/map_picture.hpp"
#include "io/octomap_file.hpp"
#include "io/spilling_map.hpp"
#include "io/station.hpp"
#include "mapping/surface_cloud.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct ExportArgs {
  fs::path station;
  fs::path out;
  ColourScale scale;
  std::vector<double> span;
  int threads = 0;
  std::uint64_t memory_bytes = 0;
  bool force = false;
};

void writePicture(const ExportArgs& args, const Station& station, const ThermalMap& map, Existing existing) {
  MapPictureOptions options;
  std::string separator;
  for (const MissionRecord& mission : station.missions()) {
    options.title += std::exchange(separator, ", ") + mission.name;
  }
  options.resolution = map.resolution();
  options.palette = args.scale.palette;
  options.span = args.scale.span;
  writeMapPicture(args.out, surfaceCloud(map), options, existing);
}

void runExport(ExportArgs& args) {
  checkEnding(args.out, {".ply", ".pcd", ".las", ".csv", ".bt", ".ot", ".png"});
  args.scale.span = spanFrom(args.span);
  const Existing existing = args.force ? Existing::replace : Existing::refuse;
  checkOutput(args.out, existing);
  const Station station = Station::open(args.station, {.threads = args.threads});
  SpillingMap spilling(folderOf(args.out), station.options());
  spilling.limitTo(args.memory_bytes);
  station.loadInto(spilling.map);
  const ThermalMap& map = spilling.map;
  const std::string ending = endingOf(args.out);
  if (ending == ".bt") {
    writeBt(args.out, map, existing);
  } else if (ending == ".ot") {
    writeOt(args.out, map, args.scale, existing);
  } else if (ending == ".png") {
    writePicture(args, station, map, existing);
  } else {
    writeCloud(args.out, surfaceCloud(map), args.scale, existing);
  }
  std::cout << args.out.string() << ": " << map.surfaceCount() << " cells that hold a surface\n";
}

}  // namespace

void addExport(CLI::App& app) {
  auto args = std::make_shared<ExportArgs>();
  CLI::App* verb =
      app.add_subcommand("export", "Write a station's map for other programs, by the ending of OUT.");
  verb->add_option("STATION", args->station, "Station (.tvx)")->required();
  verb->add_option(
          "OUT", args->out,
          "Points, one a cell that holds a surface: .ply (CloudCompare), .pcd (PCL), .las (LAS 1.4), .csv; "
          "OctoMap: .bt (occupancy), .ot (with temperature as colour); picture: .png")
      ->required();
  verb->add_option("--span", args->span,
                   "Temperatures at the two ends of the palette, LO HI [C] (default: 2nd to 98th percentile)")
      ->expected(2);
  addPalette(*verb, args->scale.palette);
  addThreadsOption(*verb, args->threads);
  addMemoryOption(*verb, args->memory_bytes,
                  "Memory that the map may take [MB]; tiles beyond it wait in a file beside OUT, which is "
                  "slower. What is written comes on top: some 50 bytes a point, or OctoMap's tree");
  verb->add_flag("--force", args->force, "Replace OUT when it is there");
  verb->callback([args] { runExport(*args); });
}

}  // namespace thermovox
