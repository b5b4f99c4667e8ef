#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "projection/pose.hpp"
#include "projection/time.hpp"

namespace thermovox {

struct StampedPose {
  Time stamp;
  Pose T_world_body;
};

/// Why a trajectory has no pose for a time.
enum class NoPose { before_start, after_end, gap };

/// Poses of the body in the world over time. Between two poses it interpolates (slerp and linear), beyond the
/// first and the last it never extrapolates, and it does not reach across a gap longer than max_gap.
class Trajectory {
 public:
  static constexpr Duration kDefaultMaxGap = std::chrono::milliseconds(500);
  /// A stamp this close to a pose's own needs no interpolation.
  static constexpr Duration kSameStamp = std::chrono::microseconds(1);

  Trajectory() = default;
  /// Precondition: stamps strictly ascending, quaternions of norm one. Throws DataError naming the index that
  /// breaks the order.
  explicit Trajectory(std::vector<StampedPose> poses, Duration max_gap = kDefaultMaxGap);

  /// T_world_body at `stamp`, or why there is none. Between two equal poses a gap does no harm: a platform
  /// that stood still before and after is taken to have stood still.
  [[nodiscard]] std::variant<Pose, NoPose> at(Time stamp) const;

  [[nodiscard]] std::span<const StampedPose> poses() const { return poses_; }
  [[nodiscard]] Duration maxGap() const { return max_gap_; }

 private:
  std::vector<StampedPose> poses_;
  Duration max_gap_ = kDefaultMaxGap;
};

}  // namespace thermovox
