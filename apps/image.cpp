#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/image_edges.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
#include "io/celsius_decoder.hpp"
#include "io/thermal_picture.hpp"
#include "io/thermal_recording.hpp"
#include "io/thermal_tiff_writer.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct ImageArgs {
  fs::path in;
  fs::path out;
  RadiometricOverrides overrides;
  EdgeArgs edges;
  std::optional<double> celsius_per_count;
  double celsius_offset = kAbsoluteZero;
  bool counts = false;
  int frame = 0;
  bool all = false;
  Palette palette = Palette::inferno;
  std::vector<double> span;
  std::vector<double> percentile{1.0, 99.9};
  bool force = false;

  [[nodiscard]] Existing existing() const { return force ? Existing::replace : Existing::refuse; }
};

bool isTiff(const fs::path& path) {
  const std::string ending = endingOf(path);
  return ending == ".tiff" || ending == ".tif";
}

void checkUsage(const ImageArgs& args) {
  checkEnding(args.out, {".tiff", ".tif", ".png", ".jpg", ".jpeg"});
  if (args.counts && !isTiff(args.out)) throw UsageError("--counts: OUT has to be a .tiff");
  if (args.all && !isTiff(args.out)) throw UsageError("--all: OUT has to be a .tiff");
  if (args.edges.wanted() && isTiff(args.out))
    throw UsageError("--edges, --visible: OUT has to be a .png or .jpg");
  if (args.counts && (args.overrides.any() || args.celsius_per_count))
    throw UsageError("--counts: the counts are written as they are, whatever they mean; leave the rest out");
  const auto& [low, high] = std::pair(args.percentile[0], args.percentile[1]);
  if (!(low >= 0.0 && low < high && high <= 100.0))
    throw UsageError("--percentile: expected two numbers LO < HI from 0 to 100");
  (void)spanFrom(args.span);
}

/// Says what a reader of the picture should know.
void warnAbout(const ImageArgs& args, const RawThermalImage& image) {
  const auto* t_linear = std::get_if<TLinear>(&image.rule);
  if (image.rule_source == RuleSource::counts && t_linear != nullptr && !args.counts) {
    spdlog::warn(
        "{}: does not say what its counts mean; by their range they are taken for {} C each, above {} C "
        "(--celsius-per-count says another)",
        args.in.string(), t_linear->celsius_per_count, t_linear->celsius_offset);
  }
}

void checkScale(const ImageArgs& args, const RawThermalImage& image) {
  if (args.celsius_per_count && image.rule_source != RuleSource::option) {
    throw DataError(args.in.string() +
                    ": its pixels have a meaning of their own, expected a TIFF of counts for "
                    "--celsius-per-count");
  }
}

TiffPlan planOf(const RawThermalImage& image, int pages, bool counts) {
  TiffPlan plan{.pages = pages, .make = image.metadata.make, .model = image.metadata.model};
  if (!counts) return plan;
  const auto* t_linear = std::get_if<TLinear>(&image.rule);
  if (t_linear == nullptr) {
    plan.t_linear_gain = 0.0;
  } else if (t_linear->celsius_offset == kAbsoluteZero) {
    plan.t_linear_gain = t_linear->celsius_per_count;
  }
  return plan;
}

/// "23.5 to 25.3 C, mean 24.2", and what is not as it should be.
std::string summaryOf(const ThermalStatistics& statistics, const std::optional<CalibratedRange>& range) {
  if (!statistics.mean) return "no temperature is known";
  std::string text =
      fmt::format("{:.1f} to {:.1f} C, mean {:.1f} C", *statistics.min, *statistics.max, *statistics.mean);
  if (statistics.unknown > 0) text += fmt::format(", {} pixels not known", statistics.unknown);
  if (range && statistics.below_range + statistics.above_range > 0) {
    text += fmt::format(", {} pixels outside the calibrated {:.0f} to {:.0f} C",
                        statistics.below_range + statistics.above_range, range->low, range->high);
  }
  return text;
}

TemperatureSpan spanOf(const ImageArgs& args, const ThermalImage& image) {
  if (const auto span = spanFrom(args.span)) return *span;
  return percentileSpan(image.celsius, args.percentile[0], args.percentile[1]).value_or(TemperatureSpan{});
}

/// Writes the frames `first` to `last` and returns what there is to say of the first one.
std::string writeFrames(const ImageArgs& args, ThermalRecording& recording, int first, int last) {
  CelsiusDecoder decoder;
  std::optional<ThermalTiffWriter> tiff;
  std::string summary;
  for (int frame = first; frame <= last; ++frame) {
    const RawThermalImage raw = recording.read(frame);
    const std::string name =
        recording.frames() == 1 ? args.in.string() : fmt::format("{}, frame {}", args.in.string(), frame);
    if (frame == first) {
      checkScale(args, raw);
      warnAbout(args, raw);
      if (isTiff(args.out))
        tiff.emplace(args.out, args.existing(), planOf(raw, last - first + 1, args.counts));
      summary = fmt::format("{} x {}", raw.width, raw.height);
    }
    if (args.counts) {
      if (raw.counts.empty())
        throw DataError(name + ": its pixels are temperatures, expected counts to write with --counts");
      tiff->add(raw.width, raw.height, raw.counts);
      continue;
    }
    const ThermalImage image = decoder.decode(raw, name, args.overrides);
    const auto& range = raw.metadata.calibrated_range;
    const std::string told = summaryOf(statisticsOf(image, range), range);
    if (frame == first) summary += ", " + told;
    if (tiff) {
      tiff->add(image);
    } else {
      writeThermalPicture(
          args.out, image,
          {args.palette, spanOf(args, image), told, registeredPicture(args.edges, raw, args.in.string())},
          args.existing());
    }
  }
  if (tiff) tiff->commit();
  return summary;
}

void runImage(const ImageArgs& args) {
  checkUsage(args);
  checkOutput(args.out, args.existing());
  RecordingOptions options;
  if (args.celsius_per_count) options.t_linear = TLinear{*args.celsius_per_count, args.celsius_offset};
  const auto recording = openThermalRecording(args.in, options);
  const int last = args.all ? recording->frames() - 1 : args.frame;
  const std::string summary = writeFrames(args, *recording, args.all ? 0 : args.frame, last);
  std::cout << args.out.string() << ": " << (args.all ? fmt::format("{} frames, ", recording->frames()) : "")
            << summary << '\n';
}

const std::map<std::string, AtmosphereModel> kModels{{"single", AtmosphereModel::single},
                                                     {"half", AtmosphereModel::half}};

/// What takes the place of the file's own parameters.
void addOverrides(CLI::App& verb, ImageArgs& args) {
  RadiometricOverrides& overrides = args.overrides;
  const CLI::Range above_absolute_zero(-273.14, 1e5);
  const auto share = CLI::Range(0.05, 1.0);
  verb.add_option("--emissivity", overrides.emissivity, "Of the object, 0.05 to 1 (default: the file's)")
      ->check(share);
  verb.add_option("--distance", overrides.distance, "From the object to the camera [m] (default: the file's)")
      ->check(CLI::NonNegativeNumber);
  verb.add_option("--reflected", overrides.reflected,
                  "Temperature of what the object mirrors [C] (default: the file's)")
      ->check(above_absolute_zero);
  verb.add_option("--atmosphere-temperature", overrides.atmosphere_temperature,
                  "Of the air [C] (default: the file's)")
      ->check(above_absolute_zero);
  verb.add_option("--humidity", overrides.humidity, "Of the air, 0 to 1 (default: the file's)")
      ->check(CLI::Range(0.0, 1.0));
  verb.add_option("--window-temperature", overrides.window_temperature,
                  "Of a window before the lens [C] (default: the file's)")
      ->check(above_absolute_zero);
  verb.add_option("--window-transmission", overrides.window_transmission,
                  "Of a window before the lens, 0.05 to 1; 1 is none (default: the file's)")
      ->check(share);
  addChoice(verb, "--atmosphere-model", overrides.model, kModels,
            "The window at the lens, or in the middle of the air as Thermimage has it (default single)");
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
                   "scale. The orientation is as stored")
      ->required();
  addOverrides(*verb, *args);
  CLI::Option* per_count =
      verb->add_option("--celsius-per-count", args->celsius_per_count,
                       "Of a TIFF of counts: degrees a count [C] (default: what the file says, else its "
                       "camera's, else by the range of the counts)")
          ->check(CLI::PositiveNumber);
  verb->add_option("--celsius-offset", args->celsius_offset, "Temperature of count 0 [C]")
      ->capture_default_str()
      ->needs(per_count);
  verb->add_flag("--counts", args->counts, "Write the counts as they are stored (16-bit TIFF)");
  CLI::Option* frame =
      verb->add_option("--frame", args->frame, "Frame of a recording, page of a TIFF, from 0")
          ->capture_default_str()
          ->check(CLI::NonNegativeNumber);
  verb->add_flag("--all", args->all, "All frames, as a TIFF of so many pages")->excludes(frame);
  addPalette(*verb, args->palette);
  CLI::Option* span =
      verb->add_option("--span", args->span, "Temperatures at the two ends of the palette, LO HI [C]")
          ->expected(2);
  verb->add_option("--percentile", args->percentile,
                   "The same as percentiles of the image, LO HI [0 to 100] (default 1 99.9)")
      ->expected(2)
      ->excludes(span);
  addEdges(*verb, args->edges);
  verb->add_flag("--force", args->force, "Replace OUT when it is there");
  verb->callback([args] { runImage(*args); });
}

}  // namespace thermovox
