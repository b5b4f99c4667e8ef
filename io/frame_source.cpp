#include "io/frame_source.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "io/input_file.hpp"
#include "io/stamped_files.hpp"
#include "io/thermal_image_file.hpp"
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
        camera_(camera) {}

  std::optional<ThermalFrame> next() override {
    const std::optional<StampedFile> row = list_.next();
    if (!row) return std::nullopt;
    auto image = std::make_shared<const ThermalImage>(
        readThermalImage(row->file, row->page, camera_.t_linear, row->place));
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
  Duration period_;
  StampedFiles list_;
  Duration time_offset_;
  ThermalCamera camera_;
};

}  // namespace

std::unique_ptr<FrameSource> readFrames(const FrameRecording& recording, const ThermalCamera& camera) {
  return std::make_unique<ListedFrames>(recording, camera);
}

}  // namespace thermovox
