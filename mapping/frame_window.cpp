#include "mapping/frame_window.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace thermovox {
namespace {

Duration distance(Time a, Time b) {
  return a < b ? b - a : a - b;
}

Uncoloured reasonOf(NoColour reason) {
  switch (reason) {
    case NoColour::outside_image:
      return Uncoloured::outside_image;
    case NoColour::hidden:
      return Uncoloured::hidden;
    case NoColour::unknown_pixel:
      break;
  }
  return Uncoloured::unknown_pixel;
}

}  // namespace

struct FrameWindow::Frame {
  /// What a frame needs to colour: made when it is closed, if a return may ask for it.
  struct Sight {
    ThermalView view;
    std::unique_ptr<Occluder> occluder;
    std::vector<std::uint16_t> samples;  ///< returns that each pixel has coloured
  };

  ThermalFrame frame;
  std::optional<Pose> T_world_camera;
  std::optional<Sight> sight;

  /// Counts one more return for the pixel nearest to `pixel`.
  int countSample(const Eigen::Vector2d& pixel) {
    const auto index =
        static_cast<std::size_t>(std::floor(pixel.y() + 0.5)) * static_cast<std::size_t>(frame.image->width) +
        static_cast<std::size_t>(std::floor(pixel.x() + 0.5));
    std::uint16_t& samples = sight->samples[index];
    if (samples < UINT16_MAX) ++samples;
    return samples;
  }
};

FrameWindow::FrameWindow(const ThermalCamera& camera, const Options& options)
    : camera_(camera), options_(options) {
  options_.lookahead = std::max(options_.lookahead, options_.limit);
}

FrameWindow::~FrameWindow() = default;

void FrameWindow::add(ThermalFrame frame, const std::optional<Pose>& T_world_camera) {
  frames_.push_back(std::make_unique<Frame>(Frame{std::move(frame), T_world_camera, std::nullopt}));
}

std::optional<Time> FrameWindow::nextDue() const {
  if (closed_ == frames_.size()) return std::nullopt;
  return nextStamp() + options_.lookahead;
}

Time FrameWindow::nextStamp() const {
  return frames_[closed_]->frame.stamp;
}

void FrameWindow::closeNext(const OccluderFor& occluder_for) {
  Frame& frame = *frames_[closed_++];
  if (!occluder_for || !frame.T_world_camera) return;
  ThermalView view(frame.frame, *frame.T_world_camera, camera_);
  std::unique_ptr<Occluder> occluder = occluder_for(view);
  std::vector<std::uint16_t> samples(frame.frame.image->celsius.size(), 0);
  frame.sight = Frame::Sight{std::move(view), std::move(occluder), std::move(samples)};
}

std::variant<FrameColour, Uncoloured> FrameWindow::colourBy(Frame& frame, const PlacedReturn& placed) const {
  if (!frame.T_world_camera) return Uncoloured::no_pose_for_frame;
  if (!frame.sight) return Uncoloured::no_frame;
  const auto result = thermovox::colour(placed, frame.sight->view, camera_, *frame.sight->occluder);
  if (const NoColour* reason = std::get_if<NoColour>(&result)) return reasonOf(*reason);
  const Colour& found = std::get<Colour>(result);
  return FrameColour{found, frame.countSample(found.pixel)};
}

std::variant<FrameColour, Uncoloured> FrameWindow::colour(const PlacedReturn& placed) {
  candidates_.clear();
  for (std::size_t i = 0; i < closed_; ++i) {
    if (distance(frames_[i]->frame.stamp, placed.stamp) <= options_.limit)
      candidates_.push_back(frames_[i].get());
  }
  std::sort(candidates_.begin(), candidates_.end(), [&](const Frame* a, const Frame* b) {
    return std::pair(distance(a->frame.stamp, placed.stamp), a->frame.stamp) <
           std::pair(distance(b->frame.stamp, placed.stamp), b->frame.stamp);
  });
  std::variant<FrameColour, Uncoloured> why_not = Uncoloured::no_frame;
  for (Frame* frame : candidates_) {
    auto result = colourBy(*frame, placed);
    if (std::holds_alternative<FrameColour>(result)) return result;
    if (frame == candidates_.front()) why_not = result;
  }
  return why_not;
}

void FrameWindow::dropBefore(Time earliest) {
  while (closed_ > 0 && frames_.front()->frame.stamp + options_.limit < earliest) {
    frames_.pop_front();
    --closed_;
  }
}

}  // namespace thermovox
