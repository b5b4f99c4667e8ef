#include "mapping/mission_mapper.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "mapping/surfaces_in_view.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr Duration kFrameSlack = std::chrono::milliseconds(50);

const char* reasonName(NoPose reason) {
  switch (reason) {
    case NoPose::before_start:
      return "before_trajectory";
    case NoPose::after_end:
      return "after_trajectory";
    case NoPose::gap:
      break;
  }
  return "trajectory_gap";
}

const char* reasonName(NoColour reason) {
  switch (reason) {
    case NoColour::outside_image:
      return "outside_image";
    case NoColour::hidden:
      return "hidden";
    case NoColour::unknown_pixel:
      break;
  }
  return "unknown_pixel";
}

void count(std::map<std::string, std::size_t>& counts, const char* reason, std::size_t n) {
  if (n > 0) counts[reason] += n;
}

/// No return entered the map: most likely the trajectory is of another time or another clock.
std::string whyNoPoints(const MissionReport& report) {
  const std::string readings = std::to_string(report.readings) + " readings";
  const bool has_returns = std::any_of(report.dropped.begin(), report.dropped.end(), [](const auto& dropped) {
    return dropped.first.find("trajectory") != std::string::npos;
  });
  if (!has_returns) {
    return "mission " + report.mission + ": none of its " + readings +
           " has a valid return, expected some within the range and intensity that the rig gives its laser";
  }
  std::string message = "mission " + report.mission + ": its trajectory covers none of its " + readings;
  const char* separator = " (";
  for (const auto& [reason, n] : report.dropped) {
    message += separator + reason + " " + std::to_string(n);
    separator = ", ";
  }
  return message + "), expected poses of the same time and clock";
}

Duration distance(Time a, Time b) {
  return a < b ? b - a : a - b;
}

MappedReturn mappedReturn(const ColouredReturn& point) {
  MappedReturn mapped{point.placed.p_world, point.placed.origin_world, point.placed.stamp, std::nullopt};
  if (point.colour) {
    mapped.temperature = TemperatureObservation{.celsius = point.colour->celsius,
                                                .sigma = point.colour->sigma,
                                                .range = point.colour->range,
                                                .incidence = std::numeric_limits<float>::quiet_NaN()};
  }
  return mapped;
}

}  // namespace

struct MissionMapper::WaitingFrame {
  ThermalView view;
  DepthSectors occluder;
};

struct MissionMapper::WaitingReading {
  Time first_stamp;
  Time last_stamp;
  std::vector<PlacedReturn> returns;
};

void MissionMapper::Options::validate() const {
  if (frame_limit < Duration::zero()) throw ConfigError("frame_limit: expected 0 s or more");
  if (lookahead < Duration::zero()) throw ConfigError("lookahead: expected 0 s or more");
  visibility.validate();
}

MissionMapper::MissionMapper(const Mission& mission, ThermalMap& map, Duration frame_period,
                             const Options& options, Sink sink)
    : mission_(mission), map_(map), options_(options), sink_(std::move(sink)) {
  options_.validate();
  if (options_.frame_limit == Duration::zero()) options_.frame_limit = frame_period / 2 + kFrameSlack;
  report_.mission = mission.name;
}

MissionMapper::~MissionMapper() = default;

Time MissionMapper::dueTime(const WaitingFrame& frame) const {
  return frame.view.frame.stamp + options_.lookahead;
}

Time MissionMapper::dueTime(const WaitingReading& reading) const {
  return reading.last_stamp + options_.frame_limit + options_.lookahead;
}

void MissionMapper::add(ThermalFrame frame) {
  if (!mission_.rig.thermal_camera)
    throw ConfigError("a thermal frame came in, but the rig has no thermal_camera");
  advanceTo(frame.stamp);
  ++report_.frames;
  const std::variant<Pose, NoPose> T_world_body = mission_.trajectory.at(frame.stamp);
  if (!std::holds_alternative<Pose>(T_world_body)) {
    ++report_.frames_without_pose;
    return;
  }
  const ThermalCamera& camera = *mission_.rig.thermal_camera;
  ThermalView view(std::move(frame), std::get<Pose>(T_world_body) * camera.T_body_camera, camera);
  DepthSectors occluder(camera.camera, view.T_camera_world, options_.visibility);
  frames_.push_back(std::make_unique<WaitingFrame>(WaitingFrame{std::move(view), std::move(occluder)}));
}

void MissionMapper::add(Reading reading) {
  advanceTo(reading.stamp);
  ++report_.readings;
  count(report_.dropped, "no_return", reading.dropped.no_return);
  count(report_.dropped, "too_near", reading.dropped.too_near);
  count(report_.dropped, "too_far", reading.dropped.too_far);
  count(report_.dropped, "too_weak", reading.dropped.too_weak);

  WaitingReading waiting{.first_stamp = reading.stamp, .last_stamp = reading.stamp};
  waiting.returns.reserve(reading.returns.size());
  for (const LaserReturn& laser_return : reading.returns) {
    const auto placed = place(laser_return, mission_.rig.lasers[reading.laser], mission_);
    if (const NoPose* reason = std::get_if<NoPose>(&placed)) {
      count(report_.dropped, reasonName(*reason), 1);
      continue;
    }
    waiting.returns.push_back(std::get<PlacedReturn>(placed));
    waiting.first_stamp = std::min(waiting.first_stamp, laser_return.stamp);
    waiting.last_stamp = std::max(waiting.last_stamp, laser_return.stamp);
  }
  readings_.push_back(std::make_unique<WaitingReading>(std::move(waiting)));
}

void MissionMapper::advanceTo(Time now) {
  while (true) {
    const bool frame_due = closed_frames_ < frames_.size() && dueTime(*frames_[closed_frames_]) < now;
    const bool reading_due = !readings_.empty() && dueTime(*readings_.front()) < now;
    if (!frame_due && !reading_due) return;
    if (frame_due && (!reading_due || dueTime(*frames_[closed_frames_]) <= dueTime(*readings_.front()))) {
      closeFrame(*frames_[closed_frames_]);
      ++closed_frames_;
    } else {
      mapReading(*readings_.front());
      readings_.pop_front();
    }
  }
}

void MissionMapper::closeFrame(WaitingFrame& frame) {
  addSurfacesInView(map_, frame.view.T_camera_world, frame.occluder);
  for (const auto& reading : readings_) {
    for (const PlacedReturn& placed : reading->returns) frame.occluder.add(placed.p_world);
  }
  frame.occluder.finish();
}

void MissionMapper::mapReading(const WaitingReading& reading) {
  Time first =
      reading.first_stamp;  // a later sweep may begin earlier, if its points have times before its own
  for (const auto& waiting : readings_) first = std::min(first, waiting->first_stamp);
  dropOldFrames(first - options_.frame_limit);
  std::vector<ColouredReturn> coloured;
  std::vector<MappedReturn> mapped;
  coloured.reserve(reading.returns.size());
  mapped.reserve(reading.returns.size());
  for (const PlacedReturn& placed : reading.returns) {
    coloured.push_back(colourReturn(placed));
    mapped.push_back(mappedReturn(coloured.back()));
    report_.first_stamp = std::min(report_.first_stamp.value_or(placed.stamp), placed.stamp);
    report_.last_stamp = std::max(report_.last_stamp.value_or(placed.stamp), placed.stamp);
  }
  report_.points += mapped.size();
  map_.integrate(mapped, options_.carving);
  if (sink_) sink_(coloured);
}

ColouredReturn MissionMapper::colourReturn(const PlacedReturn& placed) {
  if (!mission_.rig.thermal_camera) {
    count(report_.uncoloured, "no_camera", 1);
    return {placed, std::nullopt};
  }
  std::vector<const WaitingFrame*> candidates;
  for (std::size_t i = 0; i < closed_frames_; ++i) {
    if (distance(frames_[i]->view.frame.stamp, placed.stamp) <= options_.frame_limit)
      candidates.push_back(frames_[i].get());
  }
  std::stable_sort(candidates.begin(), candidates.end(), [&](const WaitingFrame* a, const WaitingFrame* b) {
    return distance(a->view.frame.stamp, placed.stamp) < distance(b->view.frame.stamp, placed.stamp);
  });
  const char* why_not = "no_frame";
  for (const WaitingFrame* frame : candidates) {
    const auto result = colour(placed, frame->view, *mission_.rig.thermal_camera, frame->occluder);
    if (const Colour* found = std::get_if<Colour>(&result)) {
      ++report_.coloured;
      return {placed, *found};
    }
    if (frame == candidates.front()) why_not = reasonName(std::get<NoColour>(result));
  }
  count(report_.uncoloured, why_not, 1);
  return {placed, std::nullopt};
}

void MissionMapper::dropOldFrames(Time before) {
  while (closed_frames_ > 0 && frames_.front()->view.frame.stamp < before) {
    frames_.pop_front();
    --closed_frames_;
  }
}

MissionReport MissionMapper::finish() {
  advanceTo(Time::max());
  if (report_.points == 0) throw DataError(whyNoPoints(report_));
  return std::move(report_);
}

MissionReport mapMission(const Mission& mission, ReadingSource& readings, FrameSource* frames,
                         ThermalMap& map, const MissionMapper::Options& options, MissionMapper::Sink sink,
                         const std::function<void(Time)>& progress) {
  MissionMapper mapper(mission, map, frames != nullptr ? frames->period() : Duration::zero(), options,
                       std::move(sink));
  std::optional<ThermalFrame> frame = frames != nullptr ? frames->next() : std::nullopt;
  while (std::optional<Reading> reading = readings.next()) {
    for (; frame && frame->stamp <= reading->stamp; frame = frames->next()) mapper.add(std::move(*frame));
    const Time stamp = reading->stamp;
    mapper.add(std::move(*reading));
    if (progress) progress(stamp);
  }
  for (; frame; frame = frames->next()) mapper.add(std::move(*frame));
  return mapper.finish();
}

}  // namespace thermovox
