#include "mapping/mission_mapper.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "mapping/grazing.hpp"
#include "mapping/painting.hpp"
#include "mapping/surfaces_in_view.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr Duration kFrameSlack = std::chrono::milliseconds(50);

Dropped reasonOf(NoPose reason) {
  switch (reason) {
    case NoPose::before_start:
      return Dropped::before_trajectory;
    case NoPose::after_end:
      return Dropped::after_trajectory;
    case NoPose::gap:
      break;
  }
  return Dropped::trajectory_gap;
}

/// No return entered the map: most likely the trajectory is of another time or another clock.
std::string whyNoPoints(const MissionReport& report, std::size_t without_pose) {
  const std::string readings = std::to_string(report.readings) + " readings";
  if (without_pose == 0) {
    return "mission " + report.mission + ": none of its " + readings +
           " has a valid return, expected some within the range and intensity that the rig gives its laser";
  }
  std::string message = "mission " + report.mission + ": its trajectory covers none of its " + readings;
  const char* separator = " (";
  for (const auto& [reason, n] : report.dropped) {
    message.append(separator).append(reason).append(" ").append(std::to_string(n));
    separator = ", ";
  }
  return message + "), expected poses of the same time and clock";
}

double widestRangeSigma(const Rig& rig) {
  double widest = 0.0;
  for (const Laser& laser : rig.lasers) widest = std::max(widest, laser.range_sigma);
  return widest;
}

MappedReturn mappedReturn(const PlacedReturn& placed, const std::optional<FrameColour>& found,
                          const GrazingView& grazing) {
  MappedReturn mapped{placed.p_world, placed.origin_world, placed.stamp, std::nullopt};
  if (found) {
    mapped.temperature =
        TemperatureObservation{.celsius = found->colour.celsius,
                               .sigma = found->colour.sigma * static_cast<float>(found->sample),
                               .range = found->colour.range,
                               .incidence = grazing.incidence,
                               .common_sigma = grazing.sigma};
  }
  return mapped;
}

}  // namespace

struct MissionMapper::WaitingReading {
  Time first_stamp;  ///< of its returns: a sweep may be stamped at its end
  Time last_stamp;
  std::vector<PlacedReturn> returns;
};

void MissionMapper::Options::validate() const {
  if (frame_limit < Duration::zero()) throw ConfigError("frame_limit: expected 0 s or more");
  if (lookahead < Duration::zero()) throw ConfigError("lookahead: expected 0 s or more");
  visibility.validate();
  scene_visibility.validate();
  if (pass != Pass::only && scene == nullptr) throw ConfigError("a second pass: expected a scene");
}

MissionMapper::MissionMapper(const Mission& mission, ThermalMap& map, const Options& options, Sink sink)
    : mission_(mission), map_(map), options_(options), sink_(std::move(sink)), motions_(mission) {
  options_.validate();
  if (options_.frame_limit == Duration::zero()) options_.frame_limit = kFrameSlack;
  options_.lookahead = std::max(options_.lookahead, options_.frame_limit);
  report_.mission = mission.name;
  if (mission.rig.thermal_camera) {
    frames_.emplace(*mission.rig.thermal_camera,
                    FrameWindow::Options{options_.frame_limit, options_.lookahead});
  }
}

MissionMapper::~MissionMapper() = default;

void MissionMapper::add(ThermalFrame frame) {
  if (!frames_) throw ConfigError("a thermal frame came in, but the rig has no thermal_camera");
  advanceTo(frame.stamp);
  ++report_.frames;
  std::optional<Pose> T_world_camera;
  const std::variant<Pose, NoPose> T_world_body = mission_.trajectory.at(frame.stamp);
  if (const Pose* pose = std::get_if<Pose>(&T_world_body)) {
    T_world_camera = *pose * mission_.rig.thermal_camera->T_body_camera;
    report_.frame_poses.push_back({frame.stamp, *T_world_camera});
  } else {
    ++report_.frames_without_pose;
  }
  frames_->add(std::move(frame), T_world_camera);
}

void MissionMapper::add(Reading reading) {
  if (reading.laser >= mission_.rig.lasers.size()) {
    throw ConfigError("a reading of laser " + std::to_string(reading.laser) + " came in, but the rig has " +
                      std::to_string(mission_.rig.lasers.size()));
  }
  advanceTo(reading.stamp);
  ++report_.readings;
  dropped_.add(Dropped::no_return, reading.dropped.no_return);
  dropped_.add(Dropped::too_near, reading.dropped.too_near);
  dropped_.add(Dropped::too_far, reading.dropped.too_far);
  dropped_.add(Dropped::too_weak, reading.dropped.too_weak);
  dropped_.add(Dropped::bad_time, reading.dropped.bad_time);

  WaitingReading waiting{.first_stamp = reading.stamp, .last_stamp = reading.stamp};
  waiting.returns.reserve(reading.returns.size());
  for (const LaserReturn& laser_return : reading.returns) {
    const auto placed = place(laser_return, mission_.rig.lasers[reading.laser], mission_);
    if (const NoPose* reason = std::get_if<NoPose>(&placed)) {
      dropped_.add(reasonOf(*reason));
      continue;
    }
    waiting.returns.push_back(std::get<PlacedReturn>(placed));
    waiting.first_stamp = std::min(waiting.first_stamp, laser_return.stamp);
    waiting.last_stamp = std::max(waiting.last_stamp, laser_return.stamp);
  }
  motions_.add(waiting.returns, reading.laser);
  readings_.push_back(std::move(waiting));
}

void MissionMapper::advanceTo(Time now) {
  const Duration delay = options_.frame_limit + options_.lookahead;
  while (true) {
    const std::optional<Time> frame_due = frames_ ? frames_->nextDue() : std::nullopt;
    const bool close = frame_due && *frame_due < now;
    const bool map = !readings_.empty() && readings_.front().last_stamp + delay < now;
    if (close && !(map && readings_.front().last_stamp + delay < *frame_due)) {
      closeFrame();
    } else if (map) {
      mapReading(readings_.front());
      readings_.pop_front();
    } else {
      break;
    }
  }
  if (frames_) frames_->dropBefore(earliestWaiting(now));
}

Time MissionMapper::earliestWaiting(Time now) const {
  Time earliest = now;
  for (const WaitingReading& waiting : readings_) earliest = std::min(earliest, waiting.first_stamp);
  return earliest;
}

void MissionMapper::closeFrame() {
  const Time stamp = frames_->nextStamp();
  const bool wanted = std::any_of(readings_.begin(), readings_.end(), [&](const WaitingReading& reading) {
    return reading.first_stamp - options_.frame_limit <= stamp &&
           stamp <= reading.last_stamp + options_.frame_limit;
  });
  if (!wanted && options_.pass != Pass::paint) return frames_->closeNext(nullptr);
  frames_->closeNext([this](const ThermalView& view) {
    return options_.pass == Pass::only ? occluderFor(view) : secondLook(view);
  });
}

std::unique_ptr<Occluder> MissionMapper::occluderFor(const ThermalView& view) {
  const Camera& camera = mission_.rig.thermal_camera->camera;
  auto depths = std::make_unique<DepthSectors>(camera, view.T_camera_world, options_.visibility);
  const double range = viewRange(view);
  addSurfacesInView(map_, ViewCone(camera, view.T_camera_world, range), *depths);
  for (const WaitingReading& reading : readings_) {
    for (const PlacedReturn& placed : reading.returns) depths->add(placed.p_world);
  }
  if (options_.scene != nullptr) {
    const auto add = [&depths](const SceneSurface& surface) { depths->add(surface.p_world); };
    options_.scene->forEachInView(camera, view.T_camera_world, range, add);
  }
  depths->finish();
  return depths;
}

std::unique_ptr<Occluder> MissionMapper::secondLook(const ThermalView& view) {
  const ThermalCamera& camera = *mission_.rig.thermal_camera;
  auto scene_view = std::make_unique<SceneView>(camera.camera, view.T_camera_world, *options_.scene,
                                                viewRange(view), options_.scene_visibility);
  if (options_.pass == Pass::paint) {
    report_.painted_outside_calibration +=
        paint(view, camera, *scene_view, {widestRangeSigma(mission_.rig), mission_.ambient}, map_);
  }
  return scene_view;
}

double MissionMapper::viewRange(const ThermalView& view) const {
  double farthest = paintRange(*mission_.rig.thermal_camera, map_.resolution());
  for (const WaitingReading& reading : readings_) {
    for (const PlacedReturn& placed : reading.returns) {
      farthest = std::max(farthest, (placed.p_world - view.T_world_camera.translation).norm());
    }
  }
  return farthest;
}

void MissionMapper::mapReading(const WaitingReading& reading) {
  std::vector<ColouredReturn> coloured;
  std::vector<MappedReturn> mapped;
  std::span<const std::variant<FrameColour, Uncoloured>> answers;
  coloured.reserve(reading.returns.size());
  mapped.reserve(reading.returns.size());
  if (frames_) answers = frames_->colour(reading.returns);
  std::vector<std::optional<FrameColour>> found;
  found.reserve(reading.returns.size());
  for (std::size_t i = 0; i < reading.returns.size(); ++i)
    found.push_back(counted(frames_ ? answers[i] : Uncoloured::no_camera));
  const std::vector<GrazingView> grazing =
      grazingViews(reading.returns, found, normalsOf(reading.returns, found), mission_.ambient);
  for (std::size_t i = 0; i < reading.returns.size(); ++i) {
    const PlacedReturn& placed = reading.returns[i];
    mapped.push_back(mappedReturn(placed, found[i], grazing[i]));
    coloured.push_back(
        {placed, found[i] ? std::optional(distrusted(found[i]->colour, grazing[i])) : std::nullopt});
    report_.first_stamp = std::min(report_.first_stamp.value_or(placed.stamp), placed.stamp);
    report_.last_stamp = std::max(report_.last_stamp.value_or(placed.stamp), placed.stamp);
  }
  report_.points += mapped.size();
  addToMap(mapped);
  if (sink_) sink_(coloured);
}

std::vector<Eigen::Vector3f> MissionMapper::normalsOf(
    std::span<const PlacedReturn> returns, std::span<const std::optional<FrameColour>> found) const {
  const double range_sigma = widestRangeSigma(mission_.rig);
  if (options_.pass != Pass::only) return sceneNormals(returns, found, *options_.scene, range_sigma);
  return readingNormals(returns, found, kBlockEdge * map_.resolution(), range_sigma);
}

void MissionMapper::addToMap(std::span<const MappedReturn> reading) {
  if (options_.pass == Pass::only) return map_.integrate(reading, options_.carving);
  if (options_.pass == Pass::paint) return;
  for (const MappedReturn& ret : reading) {
    if (ret.temperature) map_.observe(map_.keyOf(ret.p_world), *ret.temperature, ret.stamp);
  }
}

void MissionMapper::countPainted() {
  if (options_.pass != Pass::paint) return;
  map_.forEachBlock([this](const BlockKey&, const Block& block) {
    block.forEachSurface(
        [this](int, const SurfaceCell& surface) { report_.painted += surface.observations > 0; });
  });
}

std::optional<FrameColour> MissionMapper::counted(const std::variant<FrameColour, Uncoloured>& answer) {
  if (const Uncoloured* reason = std::get_if<Uncoloured>(&answer)) {
    uncoloured_.add(*reason);
    return std::nullopt;
  }
  const FrameColour& found = std::get<FrameColour>(answer);
  ++report_.coloured;
  const auto& range = found.view->frame.image->calibrated_range;
  if (range && (range->isBelow(found.colour.celsius) || range->isAbove(found.colour.celsius)))
    ++report_.outside_calibration;
  return found;
}

MissionReport MissionMapper::finish() {
  advanceTo(Time::max());
  countPainted();
  report_.dropped = namedCounts(dropped_);
  report_.uncoloured = namedCounts(uncoloured_);
  if (report_.points == 0) {
    const std::size_t without_pose = dropped_.of(Dropped::before_trajectory) +
                                     dropped_.of(Dropped::after_trajectory) +
                                     dropped_.of(Dropped::trajectory_gap);
    throw DataError(whyNoPoints(report_, without_pose));
  }
  report_.shared_motions = motions_.means();
  return std::move(report_);
}

MissionReport mapMission(const MissionStreams& streams, ThermalMap& map, MissionMapper::Options options,
                         const MissionListeners& listeners) {
  FrameSource* frames = streams.frames;
  if (frames != nullptr && options.frame_limit == Duration::zero()) {
    options.frame_limit = frames->period() / 2 + kFrameSlack;
  }
  MissionMapper mapper(streams.mission, map, options, listeners.points);
  std::optional<ThermalFrame> frame = frames != nullptr ? frames->next() : std::nullopt;
  while (std::optional<Reading> reading = streams.readings.next()) {
    for (; frame && frame->stamp <= reading->stamp; frame = frames->next()) mapper.add(std::move(*frame));
    const Time stamp = reading->stamp;
    mapper.add(std::move(*reading));
    if (listeners.progress) listeners.progress(stamp);
  }
  for (; frame; frame = frames->next()) mapper.add(std::move(*frame));
  return mapper.finish();
}

}  // namespace thermovox
