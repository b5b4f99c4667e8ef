#include "io/frame_source.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "io/celsius_decoder.hpp"
#include "io/input_file.hpp"
#include "io/scale_warning.hpp"
#include "io/stamped_files.hpp"
#include "io/thermal_recording.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

StampedFiles openList(const FrameRecording& recording) {
  return {std::make_unique<std::ifstream>(openInput(recording.list)), recording.list.string(),
          recording.folder, StampedFiles::Pages::allow};
}

/// The median of the times from frame to frame: a pause of the recording does not move it.
Duration medianPeriod(const FrameRecording& recording) {
  StampedFiles list = openList(recording);
  std::vector<Duration> periods;
  std::optional<Time> previous;
  while (const std::optional<StampedFile> row = list.next()) {
    if (previous) periods.push_back(row->stamp - *previous);
    previous = row->stamp;
  }
  if (!previous)
    throw DataError(recording.list.string() + ": lists no image, expected timestamp,file[,page]");
  if (periods.empty()) return Duration::zero();
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

class ListedFrames final : public FrameSource {
 public:
  ListedFrames(const FrameRecording& recording, const ThermalCamera& camera)
      : period_(medianPeriod(recording)),
        list_(openList(recording)),
        time_offset_(recording.time_offset),
        radiometry_(recording.radiometry),
        ambient_(recording.ambient),
        warn_(recording.warn),
        camera_(camera) {}

  std::optional<ThermalFrame> next() override {
    const std::optional<StampedFile> row = list_.next();
    if (!row) return std::nullopt;
    auto image = std::make_shared<const ThermalImage>(read(*row));
    if (image->width != camera_.camera.width() || image->height != camera_.camera.height()) {
      throw DataError(row->file.string() + ": is " + std::to_string(image->width) + " x " +
                      std::to_string(image->height) + " pixels, expected " +
                      std::to_string(camera_.camera.width()) + " x " +
                      std::to_string(camera_.camera.height()) + " as the rig's thermal camera");
    }
    std::string name = row->written;
    if (row->page > 0) name += " page " + std::to_string(row->page);
    return ThermalFrame{row->stamp + time_offset_, std::move(image), std::move(name)};
  }

  Duration period() const override { return period_; }

 private:
  void warnOfScale(const RawThermalImage& raw, const std::string& name) {
    if (!warn_) return;
    const auto warning =
        scaleWarning(raw, name, {"the rig", "celsius_per_count and celsius_offset of the rig"});
    if (!warning) return;
    warn_(*warning);
    warn_ = nullptr;
  }

  /// The image of a row. Rows that follow each other are often frames of one file, which stays open.
  ThermalImage read(const StampedFile& row) {
    if (!recording_ || row.file != opened_) {
      recording_ = openThermalRecording(
          row.file,
          {.t_linear = camera_.t_linear, .named_by = row.place, .visible = VisibleInFrame::leave_out});
      opened_ = row.file;
    }
    const RawThermalImage raw = recording_->read(row.page);
    warnOfScale(raw, row.file.string());
    const auto* parameters = std::get_if<RadiometricParameters>(&raw.rule);
    if (parameters == nullptr) return decoder_.decode(raw, row.file.string(), radiometry_);
    RadiometricOverrides overrides = radiometry_.orElse({.atmosphere_temperature = ambient_});
    overrides.distance = 0.0;
    ThermalImage image = decoder_.decode(raw, row.file.string(), overrides);
    const RadiometricParameters wanted = overrides.applyTo(*parameters);
    if (!air_ || !(air_->parameters() == wanted)) air_ = std::make_shared<const AirPath>(wanted);
    image.air = air_;
    return image;
  }

  Duration period_;
  StampedFiles list_;
  Duration time_offset_;
  RadiometricOverrides radiometry_;
  std::optional<double> ambient_;
  std::function<void(const std::string&)> warn_;  ///< empty once it has been heard
  ThermalCamera camera_;
  std::filesystem::path opened_;
  std::unique_ptr<ThermalRecording> recording_;
  CelsiusDecoder decoder_;
  std::shared_ptr<const AirPath> air_;  ///< of the last frame with parameters of its own
};

}  // namespace

std::unique_ptr<FrameSource> readFrames(const FrameRecording& recording, const ThermalCamera& camera) {
  return std::make_unique<ListedFrames>(recording, camera);
}

}  // namespace thermovox
