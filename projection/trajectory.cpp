#include "projection/trajectory.hpp"

#include <algorithm>
#include <utility>

#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr auto kByStamp = [](const StampedPose& pose, Time stamp) { return pose.stamp < stamp; };

}  // namespace

Trajectory::Trajectory(std::vector<StampedPose> poses, Duration max_gap)
    : poses_(std::move(poses)), max_gap_(max_gap) {
  if (max_gap <= Duration::zero()) {
    throw ConfigError("max_gap: expected more than 0 s, found " + std::to_string(toSeconds(max_gap)) + " s");
  }
  const auto disorder = std::adjacent_find(poses_.begin(), poses_.end(),
                                           [](const auto& a, const auto& b) { return b.stamp <= a.stamp; });
  if (disorder != poses_.end()) {
    throw DataError("trajectory: pose " + std::to_string(disorder - poses_.begin() + 1) + " has stamp " +
                    formatTime(std::next(disorder)->stamp) + ", expected later than " +
                    formatTime(disorder->stamp));
  }
}

std::variant<Pose, NoPose> Trajectory::at(Time stamp) const {
  const auto next = std::lower_bound(poses_.begin(), poses_.end(), stamp, kByStamp);
  // Sums, not differences: those of stamps from both ends of the time scale leave the 64 bits.
  if (next != poses_.end() && next->stamp - kSameStamp <= stamp) return next->T_world_body;
  if (next != poses_.begin() && stamp <= std::prev(next)->stamp + kSameStamp) {
    return std::prev(next)->T_world_body;
  }
  if (next == poses_.begin()) return NoPose::before_start;
  if (next == poses_.end()) return NoPose::after_end;

  const StampedPose& previous = *std::prev(next);
  if (previous.T_world_body == next->T_world_body) return previous.T_world_body;
  if (next->stamp - max_gap_ > previous.stamp) return NoPose::gap;
  const Duration interval = next->stamp - previous.stamp;
  const double fraction =
      static_cast<double>((stamp - previous.stamp).count()) / static_cast<double>(interval.count());
  return interpolate(previous.T_world_body, next->T_world_body, fraction);
}

}  // namespace thermovox
