#include "io/spot_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "io/picture_canvas.hpp"
#include "io/thermal_picture.hpp"
#include "io/visible_frames.hpp"
#include "projection/error.hpp"
#include "projection/image_through_air.hpp"

namespace thermovox {
namespace {

constexpr int kEdgePx = 320;  ///< a crop's picture has about this edge

/// A spot that a frame is known to have seen.
struct SeenSpot {
  int id = 0;
  const Hotspot* spot = nullptr;
};

std::size_t numberOf(const StationHotspots& found, const OpenedMission& opened) {
  const auto mission =
      std::find_if(found.missions.begin(), found.missions.end(),
                   [&](const MissionRecord& record) { return record.name == opened.mission.name; });
  if (mission != found.missions.end()) return static_cast<std::size_t>(mission - found.missions.begin());
  std::string names;
  for (const MissionRecord& record : found.missions) names += (names.empty() ? "" : ", ") + record.name;
  throw DataError(fmt::format("{}: found mission {}, expected one of the station's: {}", opened.file.string(),
                              opened.mission.name, names));
}

/// In the order of their frames.
std::vector<SeenSpot> seenSpots(const StationHotspots& found, std::size_t mission) {
  std::vector<SeenSpot> spots;
  for (const HotspotTrack& track : found.history.tracks()) {
    if (track.lastSeen() != mission) continue;
    const Hotspot& spot = *track.seen[mission];
    if (spot.best_frame) spots.push_back({track.id, &spot});
  }
  std::stable_sort(spots.begin(), spots.end(), [](const SeenSpot& a, const SeenSpot& b) {
    return a.spot->best_frame->stamp < b.spot->best_frame->stamp;
  });
  return spots;
}

/// The pixels within `half` px of one, and as many more on the other side where the image ends.
cv::Rect windowAround(const Eigen::Vector2d& pixel, int half, const cv::Size& image) {
  const int width = std::min(2 * half + 1, image.width);
  const int height = std::min(2 * half + 1, image.height);
  const auto first = [half](double middle, int length, int whole) {
    return std::clamp(static_cast<int>(std::lround(middle)) - half, 0, whole - length);
  };
  return {first(pixel.x(), width, image.width), first(pixel.y(), height, image.height), width, height};
}

/// Where a pixel of the whole image is once a window of it was scaled to `drawn`; a pixel's centre is whole.
Eigen::Vector2d placeIn(const cv::Rect& window, const cv::Size& drawn, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - window.x + 0.5) * drawn.width / window.width - 0.5,
          (pixel.y() - window.y + 0.5) * drawn.height / window.height - 0.5};
}

ThermalImage partOf(const ThermalImage& image, const cv::Rect& window) {
  ThermalImage part{.width = window.width, .height = window.height};
  for (int v = window.y; v < window.br().y; ++v) {
    for (int u = window.x; u < window.br().x; ++u) part.celsius.push_back(image.at(u, v));
  }
  part.air = image.air;
  part.noise_gain = image.noise_gain;
  part.calibrated_range = image.calibrated_range;
  return part;
}

/// How far the crop reaches from the spot, px of the thermal frame: to see its surroundings, too.
int reachOf(const Hotspot& spot, const Camera& camera) {
  const double radius = std::max(2.0 * spot.width, 0.5 * spot.extent.maxCoeff());
  const double px = camera.fx() * radius / std::max(static_cast<double>(spot.best_view.range), 0.01);
  return static_cast<int>(std::lround(std::clamp(2.5 * px, 12.0, 40.0)));
}

FrameCrop thermalCrop(const ThermalFrame& frame, const Hotspot& spot, int reach) {
  const Eigen::Vector2d& pixel = spot.best_frame->pixel;
  const cv::Rect window = windowAround(pixel, reach, {frame.image->width, frame.image->height});
  const std::vector<double> distances(static_cast<std::size_t>(window.area()), spot.best_view.range);
  const ThermalImage part = imageThroughAir(partOf(*frame.image, window), distances);
  FrameCrop crop{.stamp = frame.stamp, .name = frame.name, .pixel = pixel, .scale = TemperatureScale{}};
  crop.scale->span = calibratedSpan(part, 1.0, 100.0);
  const int zoom = std::max(1, kEdgePx / std::max(window.width, window.height));
  const cv::Mat painted = paintTemperatures(part, *crop.scale, zoom);
  crop.bytes = pngOf(painted);
  crop.width_px = painted.cols;
  crop.height_px = painted.rows;
  crop.spot_px = placeIn(window, painted.size(), pixel);
  return crop;
}

/// The visible pictures of a mission that has a camera for them, on the mission's clock.
class VisibleCrops {
 public:
  explicit VisibleCrops(const OpenedMission& opened)
      : mission_(opened.mission),
        pictures_(*opened.visible_list, opened.folder, opened.mission.rig.visible_camera->camera),
        within_(std::max<Duration>(opened.frames->period(), std::chrono::milliseconds(100))) {}

  /// As much of the surroundings as `reach` px of the thermal frame. Frames have to ascend.
  std::optional<FrameCrop> of(const Hotspot& spot, int reach) {
    const std::optional<StampedFile> file = pictures_.nearestFile(spot.best_frame->stamp, within_);
    if (!file) return std::nullopt;
    const auto body = mission_.trajectory.at(file->stamp);
    const auto* T_world_body = std::get_if<Pose>(&body);
    if (T_world_body == nullptr) return std::nullopt;
    const MountedCamera& mounted = *mission_.rig.visible_camera;
    const Eigen::Vector3d p_camera =
        (*T_world_body * mounted.T_body_camera).inverse() * spot.position.p_world;
    const std::optional<Eigen::Vector2d> pixel = mounted.camera.project(p_camera);
    if (!pixel) return std::nullopt;
    const double metres =
        reach * static_cast<double>(spot.best_view.range) / mission_.rig.thermal_camera->camera.fx();
    const int half =
        std::max(8, static_cast<int>(std::lround(metres * mounted.camera.fx() / p_camera.norm())));
    return crop(*file, *pixel, half);
  }

 private:
  [[nodiscard]] FrameCrop crop(const StampedFile& file, const Eigen::Vector2d& pixel, int half) const {
    RgbPicture whole = readColourPicture(file.file, file.place, mission_.rig.visible_camera->camera);
    const cv::Mat rgb(whole.height, whole.width, CV_8UC3, whole.rgb.data());
    const cv::Rect window = windowAround(pixel, half, rgb.size());
    const double scale = static_cast<double>(kEdgePx) / std::max(window.width, window.height);
    cv::Mat drawn;
    cv::resize(rgb(window), drawn, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
    cv::cvtColor(drawn, drawn, cv::COLOR_RGB2BGR);
    return {.bytes = jpegOf(drawn),
            .width_px = drawn.cols,
            .height_px = drawn.rows,
            .spot_px = placeIn(window, drawn.size(), pixel),
            .stamp = file.stamp,
            .name = file.written,
            .pixel = pixel,
            .scale = std::nullopt};
  }

  const Mission& mission_;
  VisibleFrames pictures_;
  Duration within_;
};

}  // namespace

SpotImagesById cutSpotImages(const StationHotspots& found, OpenedMission& opened) {
  const std::vector<SeenSpot> spots = seenSpots(found, numberOf(found, opened));
  SpotImagesById images;
  if (spots.empty()) return images;
  if (!opened.frames) {
    throw DataError(opened.file.string() + ": has no thermal images, expected those that the hot spots of " +
                    opened.mission.name + " were seen in");
  }
  std::optional<VisibleCrops> visible;
  if (opened.visible_list && opened.mission.rig.visible_camera) visible.emplace(opened);
  std::optional<ThermalFrame> frame = opened.frames->next();
  for (const auto& [id, spot] : spots) {
    const Time seen = spot->best_frame->stamp;
    while (frame && frame->stamp < seen) frame = opened.frames->next();
    if (!frame || frame->stamp != seen) {
      throw DataError(
          fmt::format("{}: has no frame at {} s, in which hot spot {} was seen best; expected the "
                      "images that mission {} was mapped from",
                      opened.thermal_list->string(), formatTime(seen), id, opened.mission.name));
    }
    const int reach = reachOf(*spot, opened.mission.rig.thermal_camera->camera);
    SpotImages& cut = images[id];
    cut.thermal = thermalCrop(*frame, *spot, reach);
    if (visible) cut.visible = visible->of(*spot, reach);
  }
  return images;
}

}  // namespace thermovox
