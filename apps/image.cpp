#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/image_edges.hpp"
#include "apps/image_job.hpp"
#include "apps/image_watch.hpp"
#include "apps/radiometry_options.hpp"
#include "apps/verbs.hpp"
#include "io/rig_file.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct ImageArgs {
  fs::path in;
  fs::path out;
  ImageJob job;
  ScaleArgs scale;
  std::vector<double> span;
  std::vector<double> percentile{1.0, 99.9};
  std::vector<CLI::Option*> of_pictures;  ///< options that say how a picture looks
  bool watched = false;
  ImageWatch watch;
};

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(std::llround(1e3 * seconds));
}

/// Whether one path is the other or lies in it.
bool isWithin(const fs::path& path, const fs::path& folder) {
  const fs::path from = fs::weakly_canonical(fs::absolute(folder));
  const fs::path to = fs::weakly_canonical(fs::absolute(path)).lexically_relative(from);
  return !to.empty() && *to.begin() != "..";
}

bool isNoFolder(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown) && !fs::is_directory(path, unknown);
}

void checkUsage(ImageArgs& args) {
  ImageJob& job = args.job;
  const bool writes_tiff = args.watched ? args.watch.ending == ".tiff" : isTiff(args.out);
  if (!args.watched) checkEnding(args.out, {".tiff", ".tif", ".png", ".jpg", ".jpeg"});
  if (args.watched && isWithin(args.out, args.in))
    throw UsageError("--watch: OUT lies in the folder that is watched; expected a folder elsewhere");
  if (job.counts && !writes_tiff) throw UsageError("--counts: OUT has to be a .tiff");
  if (job.all && !writes_tiff) throw UsageError("--all: OUT has to be a .tiff");
  if (writes_tiff) {
    refuseOptions(args.of_pictures,
                  args.watched ? "--watch writes TIFFs without colours, expected --as png or --as jpg"
                               : "OUT is a TIFF, which has no colours, expected a .png or .jpg");
  }
  if (args.watched && isNoFolder(args.in))
    throw UsageError("--watch: IN is the file " + args.in.string() + ", expected the camera's folder");
  checkRadiometry(job.overrides);
  if (job.counts && (job.overrides.any() || args.scale.celsius_per_count || !job.edges.by_rig.rig.empty()))
    throw UsageError("--counts: the counts are written as they are, whatever they mean; leave the rest out");
  const auto& [low, high] = std::pair(args.percentile[0], args.percentile[1]);
  if (!(low >= 0.0 && low < high && high <= 100.0))
    throw UsageError("--percentile: expected two numbers LO < HI from 0 to 100");
  job.percentile = {low, high};
  job.span = spanFrom(args.span);
  job.t_linear = args.scale.scale();
}

/// Of TIFFs of counts, where the rig says it.
std::optional<TLinear> scaleOfRig(const fs::path& file) {
  const Rig rig = readRig(file);
  return rig.thermal_camera ? rig.thermal_camera->t_linear : std::nullopt;
}

void runImage(ImageArgs& args) {
  checkUsage(args);
  if (!args.job.edges.by_rig.rig.empty()) args.job.rig_t_linear = scaleOfRig(args.job.edges.by_rig.rig);
  if (args.watched) {
    args.watch.folder = args.in;
    args.watch.out_folder = args.out;
    watchImages(args.job, args.watch);
  } else {
    const std::string summary = writeImage(args.job, args.in, args.out);
    std::cout << args.out.string() << ": " << summary << '\n';
  }
}

/// Of pictures; a TIFF has none of it.
void addLooks(CLI::App& verb, ImageArgs& args) {
  CLI::Option* palette = addPalette(verb, args.job.palette);
  CLI::Option* span =
      verb.add_option("--span", args.span, "Temperatures at the two ends of the palette, LO HI [C]")
          ->expected(2);
  CLI::Option* percentile =
      verb.add_option(
              "--percentile", args.percentile,
              "The same as percentiles of the image, of what the camera is calibrated for, LO HI [0 to 100] "
              "(default 1 99.9)")
          ->expected(2)
          ->excludes(span);
  args.of_pictures = {palette, span, percentile};
  for (CLI::Option* edges : addEdges(verb, args.job.edges)) args.of_pictures.push_back(edges);
}

void addWatch(CLI::App& verb, ImageArgs& args) {
  CLI::Option* watched = verb.add_flag(
      "--watch", args.watched,
      "IN is a camera's folder, OUT a folder elsewhere: every image that appears, and those that are there, "
      "becomes OUT/its name and ending with another (--as), once it is wholly written, until interrupted. "
      "The folder may vanish and come back, as a card does");
  addChoice(verb, "--as", args.watch.ending,
            std::map<std::string, std::string>{{"tiff", ".tiff"}, {"png", ".png"}, {"jpg", ".jpg"}},
            "What --watch writes (default tiff)")
      ->needs(watched);
  verb.add_flag_callback(
          "--newest-first", [&args] { args.watch.camera.order = CameraFolder::Order::newest_first; },
          "Of several new images the newest first (default: the oldest)")
      ->needs(watched);
  verb.add_flag("--new-only", args.watch.pass_over, "Pass over what is in the folder at the start")
      ->needs(watched);
  verb.add_option("--images", args.watch.most, "End after so many images")->needs(watched);
  const auto seconds = [&verb, watched](const char* name, auto set, const char* help) {
    verb.add_option_function<double>(
            name, [set](double value) { set(milliseconds(value)); }, help)
        ->check(CLI::Range(0.0, 1e6))
        ->needs(watched);
  };
  seconds(
      "--idle", [&args](auto time) { args.watch.longest_idle = time; },
      "End when no image has come for so long [s]");
  seconds(
      "--settled", [&args](auto time) { args.watch.camera.settled = time; },
      "Where the file system does not tell that a file was closed (memory cards, network): take an image "
      "as whole when it has not changed for so long [s] (default 2)");
}

}  // namespace

void addImage(CLI::App& app) {
  auto args = std::make_shared<ImageArgs>();
  CLI::App* verb = app.add_subcommand(
      "image",
      "Decode a thermal image: temperatures as TIFF, or a picture with a scale, by the ending of OUT.");
  verb->add_option(
          "IN", args->in,
          "Radiometric JPEG (FLIR, Zenmuse XT), FLIR recording (.seq, .csq, .fff), or TIFF of 16-bit "
          "counts or 32-bit floats in C")
      ->required();
  verb->add_option("OUT", args->out,
                   ".tiff: 32-bit floats in C, NaN where not known; .png, .jpg: picture by a palette with a "
                   "scale, in which temperatures that the camera is not calibrated for have colours of their "
                   "own. The orientation is as stored")
      ->required();
  addRadiometryOptions(*verb, args->job.overrides);
  addDistanceOption(*verb, args->job.overrides);
  addScaleOptions(*verb, args->scale,
                  "what the rig says, else the file, else its camera's, else by the range of the counts");
  verb->add_flag("--counts", args->job.counts, "Write the counts as they are stored (16-bit TIFF)");
  CLI::Option* frame =
      verb->add_option("--frame", args->job.frame, "Frame of a recording, page of a TIFF, from 0")
          ->capture_default_str()
          ->check(CLI::NonNegativeNumber);
  verb->add_flag("--all", args->job.all, "All frames, as a TIFF of so many pages")->excludes(frame);
  addLooks(*verb, *args);
  addWatch(*verb, *args);
  verb->add_flag_callback(
      "--force", [args] { args->job.existing = Existing::replace; }, "Replace OUT when it is there");
  verb->callback([args] { runImage(*args); });
}

}  // namespace thermovox
