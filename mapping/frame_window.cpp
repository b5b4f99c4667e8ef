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

/// Nearest in time first, of two equally near ones the earlier.
struct FrameWindow::Nearer {
  Time stamp;
  [[nodiscard]] bool operator()(const Frame* a, const Frame* b) const {
    return std::pair(distance(a->frame.stamp, stamp), a->frame.stamp) <
           std::pair(distance(b->frame.stamp, stamp), b->frame.stamp);
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
  return FrameColour{found, frame.countSample(found.pixel), &frame.sight->view};
}

FrameWindow::Candidates FrameWindow::candidatesAt(Time stamp) const {
  Candidates candidates;
  for (std::size_t i = 0; i < closed_; ++i) {
    if (distance(frames_[i]->frame.stamp, stamp) <= options_.limit) candidates.push_back(frames_[i].get());
  }
  std::sort(candidates.begin(), candidates.end(), Nearer{stamp});
  return candidates;
}

std::variant<FrameColour, Uncoloured> FrameWindow::colour(const PlacedReturn& placed) {
  const Candidates candidates = candidatesAt(placed.stamp);
  Answer why_not = Uncoloured::no_frame;
  for (Frame* frame : candidates) {
    Answer answer = colourBy(*frame, placed);
    if (std::holds_alternative<FrameColour>(answer)) return answer;
    if (frame == candidates.front()) why_not = answer;
  }
  return why_not;
}

bool FrameWindow::areCandidatesAt(const Candidates& candidates, Time stamp) const {
  std::size_t within = 0;
  for (std::size_t i = 0; i < closed_; ++i)
    within += distance(frames_[i]->frame.stamp, stamp) <= options_.limit ? 1 : 0;
  if (within != candidates.size()) return false;
  const bool all_within = std::all_of(candidates.begin(), candidates.end(), [&](const Frame* frame) {
    return distance(frame->frame.stamp, stamp) <= options_.limit;
  });
  return all_within && std::is_sorted(candidates.begin(), candidates.end(), Nearer{stamp});
}

void FrameWindow::findCandidates(std::span<const PlacedReturn> reading) {
  candidates_.clear();
  candidates_of_.clear();
  for (const PlacedReturn& placed : reading) {
    // Neighbours in time mostly have the same.
    if (candidates_.empty() || !areCandidatesAt(candidates_.back(), placed.stamp))
      candidates_.push_back(candidatesAt(placed.stamp));
    candidates_of_.push_back(static_cast<std::uint32_t>(candidates_.size() - 1));
  }
}

std::vector<FrameWindow::Question> FrameWindow::questions(std::size_t attempt) const {
  std::vector<Question> questions;
  for (std::uint32_t i = 0; i < candidates_of_.size(); ++i) {
    const Candidates& candidates = candidates_[candidates_of_[i]];
    if (coloured_by_[i] != nullptr || attempt >= candidates.size()) continue;
    Frame* const frame = candidates[attempt];
    auto found = std::find_if(questions.rbegin(), questions.rend(),
                              [&](const Question& question) { return question.frame == frame; });
    if (found == questions.rend()) {
      questions.push_back({frame, {}});
      found = questions.rbegin();
    }
    found->returns.push_back(i);
  }
  return questions;
}

void FrameWindow::ask(const Question& question, std::span<const PlacedReturn> reading, std::size_t attempt) {
  Frame& frame = *question.frame;
  if (!frame.sight) {
    const Uncoloured reason = frame.T_world_camera ? Uncoloured::no_frame : Uncoloured::no_pose_for_frame;
    if (attempt > 0) return;
    for (const std::uint32_t i : question.returns) answers_[i] = reason;
    return;
  }
  const std::span<const PointColour> colours =
      batch_.colour(reading, question.returns, {frame.sight->view, camera_, *frame.sight->occluder});
  for (std::size_t k = 0; k < colours.size(); ++k) {
    const std::uint32_t i = question.returns[k];
    const std::variant<Colour, NoColour> result = colours[k].by(frame.frame.stamp);
    if (const Colour* colour = std::get_if<Colour>(&result)) {
      answers_[i] = FrameColour{.colour = *colour, .view = &frame.sight->view};
      coloured_by_[i] = &frame;
    } else if (attempt == 0) {
      answers_[i] = reasonOf(std::get<NoColour>(result));
    }
  }
}

std::span<const std::variant<FrameColour, Uncoloured>> FrameWindow::colour(
    std::span<const PlacedReturn> reading) {
  findCandidates(reading);
  answers_.assign(reading.size(), Uncoloured::no_frame);
  coloured_by_.assign(reading.size(), nullptr);
  std::size_t attempts = 0;
  for (const Candidates& candidates : candidates_) attempts = std::max(attempts, candidates.size());
  for (std::size_t attempt = 0; attempt < attempts; ++attempt) {
    for (const Question& question : questions(attempt)) ask(question, reading, attempt);
  }
  // The samples of a pixel are numbered in the order of the returns, whichever attempt found them.
  for (std::size_t i = 0; i < reading.size(); ++i) {
    if (coloured_by_[i] == nullptr) continue;
    FrameColour& found = std::get<FrameColour>(answers_[i]);
    found.sample = coloured_by_[i]->countSample(found.colour.pixel);
  }
  return answers_;
}

void FrameWindow::dropBefore(Time earliest) {
  while (closed_ > 0 && frames_.front()->frame.stamp + options_.limit < earliest) {
    frames_.pop_front();
    --closed_;
  }
}

}  // namespace thermovox
