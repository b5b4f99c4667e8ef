#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/map_report.hpp"
#include "apps/progress.hpp"
#include "apps/radiometry_options.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
#include "io/folders.hpp"
#include "io/mission_folder.hpp"
#include "io/mission_pictures.hpp"
#include "io/overlay_picture.hpp"
#include "mapping/mission_mapper.hpp"
#include "projection/error.hpp"
#include "projection/image_through_air.hpp"
#include "projection/registration.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct OverlayArgs {
  fs::path mission;
  fs::path out;
  std::size_t every = 1;
  std::vector<double> span;
  RadiometricOverrides radiometry;
  bool edges = true;
  bool force = false;
};

/// The points of one frame, with what is needed to choose among them.
struct FramePoints {
  std::vector<OverlayPoint> points;
  std::vector<Duration> from_frame;           ///< how far in time each return is from the frame
  std::vector<Eigen::Vector3d> places_world;  ///< metres
  std::vector<PixelDepth> distances;          ///< from the camera, metres, at the points' pixels
};

using Order = bool (*)(const OverlayPoint&, const OverlayPoint&);

void label(std::vector<OverlayPoint>& points, const char* name, Order before) {
  auto chosen = std::min_element(points.begin(), points.end(), before);
  if (chosen->label.empty()) chosen->label = name;
}

void labelCentre(std::vector<OverlayPoint>& points, const ThermalImage& image) {
  const Eigen::Vector2d centre(0.5 * (image.width - 1), 0.5 * (image.height - 1));
  const auto chosen =
      std::min_element(points.begin(), points.end(), [&](const OverlayPoint& a, const OverlayPoint& b) {
        return (a.pixel - centre).squaredNorm() < (b.pixel - centre).squaredNorm();
      });
  chosen->label = "centre";
}

/// Which points get their temperature and distance written beside them: of a beam the one nearest in time to
/// the frame, of a scan the left, central and right one, of a cloud the hottest, central and nearest one.
void choosePoints(FramePoints& frame, LaserKind kind, const ThermalImage& image) {
  if (kind == LaserKind::beam) {
    const auto nearest = std::min_element(frame.from_frame.begin(), frame.from_frame.end());
    frame.points[static_cast<std::size_t>(nearest - frame.from_frame.begin())].label = "beam";
    return;
  }
  labelCentre(frame.points, image);
  if (kind == LaserKind::scan) {
    label(frame.points, "left", [](const auto& a, const auto& b) { return a.pixel.x() < b.pixel.x(); });
    label(frame.points, "right", [](const auto& a, const auto& b) { return a.pixel.x() > b.pixel.x(); });
  } else {
    label(frame.points, "hottest", [](const auto& a, const auto& b) { return a.celsius > b.celsius; });
    label(frame.points, "nearest", [](const auto& a, const auto& b) { return a.range < b.range; });
  }
}

/// Whether there are visible pictures whose edges can be drawn; says so where only the rig is in the way.
bool hasVisible(const OpenedMission& opened) {
  if (!opened.visible_list) return false;
  if (opened.mission.rig.visible_camera) return true;
  spdlog::warn("{}: has no visible_camera, so the edges of the mission's visible pictures are not drawn",
               opened.rig_file.string());
  return false;
}

/// The frame as its points are read: of a radiometric one, each pixel through the air of the point nearest to
/// it in the image.
ThermalImage imageAsRead(const ThermalImage& image, const FramePoints& points) {
  if (!image.air) return image;
  return imageThroughAir(image, nearestDepths(image.width, image.height, points.distances));
}

/// Gathers the coloured points by frame and draws a frame once no later return can belong to it.
class OverlaySeries {
 public:
  OverlaySeries(const OverlayArgs& args, const OpenedMission& opened, std::unique_ptr<FrameSource> frames,
                fs::path folder)
      : args_(args),
        name_(opened.mission.name),
        kind_(opened.mission.rig.lasers.front().kind),
        patience_(frames->period() + std::chrono::seconds(1)),
        frames_(std::move(frames)),
        folder_(std::move(folder)),
        table_(folder_ / "overlay.csv", Existing::refuse) {
    if (args.edges && hasVisible(opened))
      edges_.emplace(opened, std::max<Duration>(frames_->period(), std::chrono::milliseconds(100)));
    table_.write("timestamp,picture,point,u,v,temperature,sigma,range\n");
  }

  void add(std::span<const ColouredReturn> reading) {
    for (const ColouredReturn& point : reading) {
      if (!point.colour) continue;
      const Time frame = point.colour->frame_stamp;
      FramePoints& gathered = gathered_[frame];
      gathered.points.push_back(
          {point.colour->pixel, point.placed.range, point.colour->celsius, point.colour->sigma, ""});
      gathered.places_world.push_back(point.placed.p_world);
      gathered.distances.push_back({point.colour->pixel, point.colour->range});
      const Time stamp = point.placed.stamp;
      gathered.from_frame.push_back(stamp < frame ? frame - stamp : stamp - frame);
    }
    if (!reading.empty()) drawBefore(reading.front().placed.stamp - patience_);
  }

  void finish() {
    drawBefore(Time::max());
    table_.commit();
  }
  [[nodiscard]] std::string summary() const {
    const std::string edges =
        edges_ ? fmt::format(", {} with the edges of a visible one", with_edges_) : std::string();
    return fmt::format("{} pictures{}, chosen points in overlay.csv", pictures_, edges);
  }

 private:
  void drawBefore(Time stamp) {
    while (!gathered_.empty() && gathered_.begin()->first < stamp) {
      const auto frame = gathered_.extract(gathered_.begin());
      std::optional<ThermalFrame> image = frames_->next();
      for (; image && image->stamp < frame.key(); image = frames_->next()) ++frame_number_;
      if (!image) return;
      if (frame_number_ % args_.every == 0) draw(*image, frame.mapped());
      ++frame_number_;
    }
  }

  void draw(const ThermalFrame& frame, FramePoints& gathered) {
    choosePoints(gathered, kind_, *frame.image);
    const std::string picture = fmt::format("frame_{:06}.png", frame_number_);
    OverlayOptions options{
        .title = fmt::format("{}   frame {}   {} s", name_, frame_number_, formatTime(frame.stamp))};
    options.span = spanFrom(args_.span);
    if (edges_) options.visible = edges_->on(frame.stamp, gathered.places_world);
    if (options.visible) ++with_edges_;
    writeOverlayPicture(folder_ / picture, imageAsRead(*frame.image, gathered), gathered.points, options,
                        Existing::refuse);
    for (const OverlayPoint& point : gathered.points) {
      if (point.label.empty()) continue;
      table_.write(fmt::format("{},{},{},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f}\n", formatTime(frame.stamp),
                               picture, point.label, point.pixel.x(), point.pixel.y(), point.celsius,
                               point.sigma, point.range));
    }
    ++pictures_;
  }

  const OverlayArgs& args_;
  std::string name_;
  LaserKind kind_;
  Duration patience_;
  std::unique_ptr<FrameSource> frames_;
  fs::path folder_;
  AtomicFile table_;
  std::map<Time, FramePoints> gathered_;
  std::size_t frame_number_ = 0;
  std::optional<MissionPictures> edges_;
  std::size_t pictures_ = 0;
  std::size_t with_edges_ = 0;
};

/// A folder beside its name that goes when it does not get that name.
class PartialFolder {
 public:
  explicit PartialFolder(const fs::path& out) : out_(out), path_(out.string() + ".partial") {
    fs::remove_all(path_);
    fs::create_directory(path_);
  }
  ~PartialFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }
  void putIntoPlace() const {
    fs::remove_all(out_);
    fs::rename(path_, out_);
  }

 private:
  fs::path out_;
  fs::path path_;
};

void checkFolder(const OverlayArgs& args) {
  if (!fs::exists(args.out) || (fs::is_directory(args.out) && fs::is_empty(args.out))) return;
  if (!args.force)
    throw DataError(args.out.string() + ": exists already, expected a new folder (or --force to replace it)");
  if (!fs::exists(args.out / "overlay.csv")) {
    throw DataError(args.out.string() +
                    ": holds no overlays (no overlay.csv in it), expected a folder that --force may replace");
  }
}

void runOverlay(OverlayArgs& args) {
  args.out = withoutSlash(args.out);
  (void)spanFrom(args.span);
  checkRadiometry(args.radiometry);
  checkFolderOf(args.out);
  checkFolder(args);
  MissionOptions options{.radiometry = args.radiometry};
  std::unique_ptr<FrameSource> frames = openMission(args.mission, options).frames;
  options.warn = [](const std::string& warning) { spdlog::warn("{}", warning); };
  OpenedMission opened = openMission(args.mission, options);
  if (!opened.frames)
    throw DataError(args.mission.string() +
                    ": has no thermal images, expected a mission with a thermal camera");
  const PartialFolder partial(args.out);
  ThermalMap map(ThermalMap::Options{});
  OverlaySeries series(args, opened, std::move(frames), partial.path());
  {
    const auto poses = opened.mission.trajectory.poses();
    Progress progress("drawing " + opened.mission.name, poses.front().stamp, poses.back().stamp);
    const auto report =
        mapMission({opened.mission, *opened.readings, opened.frames.get()}, map, {},
                   {.points = [&series](std::span<const ColouredReturn> reading) { series.add(reading); },
                    .progress = [&progress](Time stamp) { progress.at(stamp); }});
    warnOfCalibration(report);
    if (report.coloured == 0) {
      throw DataError(args.mission.string() +
                      ": no laser point falls into a thermal image, expected some; check clocks and rig");
    }
  }
  series.finish();
  partial.putIntoPlace();
  std::cout << args.out.string() << ": " << series.summary() << '\n';
}

}  // namespace

void addOverlay(CLI::App& app) {
  auto args = std::make_shared<OverlayArgs>();
  CLI::App* verb =
      app.add_subcommand("overlay",
                         "Draw the laser points on the thermal images, with temperature [C] and "
                         "distance [m] beside chosen points, and the edges of the visible pictures "
                         "(visible.csv) where the rig has a visible camera. In radiometric images each "
                         "pixel is shown through the air of the laser point nearest to it in the image, as "
                         "each point is through its own.");
  verb->add_option("MISSION", args->mission, "Mission folder")->required();
  verb->add_option("OUT_DIR", args->out, "Folder for the pictures (PNG) and overlay.csv")->required();
  verb->add_option("--every", args->every, "Draw every so many frames")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  verb->add_option("--span", args->span,
                   "Temperatures at the two ends of the palette, LO HI [C] (default: of each image)")
      ->expected(2);
  addRadiometryOptions(*verb, args->radiometry);
  verb->add_flag("!--no-edges", args->edges, "Leave the edges of the visible pictures out");
  verb->add_flag("--force", args->force, "Replace overlays that are there");
  verb->callback([args] { runOverlay(*args); });
}

}  // namespace thermovox
