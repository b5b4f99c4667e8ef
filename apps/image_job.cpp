#include "apps/image_job.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <utility>
#include <variant>

#include "apps/radiometry_options.hpp"
#include "io/celsius_decoder.hpp"
#include "io/scale_warning.hpp"
#include "io/thermal_picture.hpp"
#include "io/thermal_recording.hpp"
#include "io/thermal_tiff_writer.hpp"
#include "projection/error.hpp"

namespace thermovox {

namespace fs = std::filesystem;

bool isTiff(const fs::path& path) {
  const std::string ending = endingOf(path);
  return ending == ".tiff" || ending == ".tif";
}

namespace {

/// Says what a reader of the picture should know.
void warnAbout(const ImageJob& job, const fs::path& in, const RawThermalImage& image) {
  if (job.t_linear) return;
  const auto warning = scaleWarning(image, in.string(), {"the rig", "--celsius-per-count"});
  if (warning) spdlog::warn("{}", *warning);
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

TemperatureSpan spanOf(const ImageJob& job, const ThermalImage& image) {
  if (job.span) return *job.span;
  return calibratedSpan(image, job.percentile.low, job.percentile.high);
}

/// Writes frame after frame into a TIFF, or one of them as a picture.
class FrameWriter {
 public:
  FrameWriter(const ImageJob& job, fs::path out, int frames)
      : job_(job), out_(std::move(out)), frames_(frames) {}

  /// Returns what there is to say of the frame. `name` stands for it in messages.
  std::string add(const RawThermalImage& raw, const std::string& name) {
    const std::string size = fmt::format("{} x {}", raw.width, raw.height);
    if (isTiff(out_) && !tiff_) tiff_.emplace(out_, job_.existing, planOf(raw, frames_, job_.counts));
    if (job_.counts) {
      if (raw.counts.empty())
        throw DataError(name + ": its pixels are temperatures, expected counts to write with --counts");
      tiff_->add(raw.width, raw.height, raw.counts);
      return size;
    }
    const ThermalImage image = decoder_.decode(raw, name, job_.overrides);
    const auto& range = raw.metadata.calibrated_range;
    const std::string told = summaryOf(statisticsOf(image, range), range);
    if (tiff_) {
      tiff_->add(image);
    } else {
      writeThermalPicture(out_, image,
                          {job_.palette, spanOf(job_, image), told, registeredPicture(job_.edges, raw, name)},
                          job_.existing);
    }
    return size + ", " + told;
  }
  void commit() {
    if (tiff_) tiff_->commit();
  }

 private:
  const ImageJob& job_;
  fs::path out_;
  int frames_;
  CelsiusDecoder decoder_;
  std::optional<ThermalTiffWriter> tiff_;
};

}  // namespace

std::string writeImage(const ImageJob& job, const fs::path& in, const fs::path& out) {
  checkOutput(out, job.existing);
  RecordingOptions options;
  options.t_linear = job.t_linear ? job.t_linear : job.rig_t_linear;
  if (!job.edges.embedded) options.visible = VisibleInFrame::leave_out;
  const auto recording = openThermalRecording(in, options);
  const int first = job.all ? 0 : job.frame;
  const int last = job.all ? recording->frames() - 1 : job.frame;
  FrameWriter writer(job, out, last - first + 1);
  std::string summary;
  for (int frame = first; frame <= last; ++frame) {
    const RawThermalImage raw = recording->read(frame);
    if (frame == first) checkScale(job.t_linear, raw, in.string());
    const std::string name =
        recording->frames() == 1 ? in.string() : fmt::format("{}, frame {}", in.string(), frame);
    const std::string told = writer.add(raw, name);
    if (frame > first) continue;
    if (!job.counts) warnAbout(job, in, raw);
    summary = told;
  }
  writer.commit();
  return job.all ? fmt::format("{} frames, {}", recording->frames(), summary) : summary;
}

}  // namespace thermovox
