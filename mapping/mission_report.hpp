#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapping/frame_window.hpp"
#include "mapping/shared_errors.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// Why a return did not enter the map.
enum class Dropped {
  no_return,          ///< NaN, infinite or zero
  too_near,           ///< under the laser's range_min
  too_far,            ///< over its range_max
  too_weak,           ///< under its min_intensity
  bad_time,           ///< a time of its own far from its sweep's
  before_trajectory,  ///< taken before the first pose
  after_trajectory,   ///< taken after the last one
  trajectory_gap,     ///< between two poses too far apart to interpolate
};

/// How many returns met one of the reasons above.
template <typename Reason, std::size_t kReasons>
class ReasonCounts {
 public:
  void add(Reason reason, std::size_t n = 1) { counts_[static_cast<std::size_t>(reason)] += n; }
  [[nodiscard]] std::size_t of(Reason reason) const { return counts_[static_cast<std::size_t>(reason)]; }

 private:
  std::array<std::size_t, kReasons> counts_{};
};
using DroppedCounts = ReasonCounts<Dropped, 8>;
using UncolouredCounts = ReasonCounts<Uncoloured, 6>;

/// The counts that are not zero under the reasons' names, as they stand in reports.
[[nodiscard]] std::map<std::string, std::size_t> namedCounts(const DroppedCounts& counts);
[[nodiscard]] std::map<std::string, std::size_t> namedCounts(const UncolouredCounts& counts);

/// Where the camera was when a frame was taken.
struct FramePose {
  Time stamp;
  Pose T_world_camera;
};

/// What became of a mission's returns: points = coloured + uncoloured; dropped ones never entered the map.
struct MissionReport {
  std::string mission;
  std::size_t readings = 0;  ///< sweeps: single ranges, scan lines or clouds
  std::size_t points = 0;
  std::size_t coloured = 0;
  /// Of the coloured: with a temperature that their camera is not calibrated for. It is taken as it is, for
  /// nothing says by how much it errs.
  std::size_t outside_calibration = 0;
  std::size_t painted_outside_calibration = 0;  ///< the same of the temperatures that frames painted
  std::map<std::string, std::size_t>
      uncoloured;  ///< by the reason's name; reasons without a return are left out
  std::map<std::string, std::size_t> dropped;  ///< likewise
  std::size_t painted = 0;                     ///< cells of the map that frames coloured, where they paint
  std::size_t frames = 0;
  std::size_t frames_without_pose = 0;
  std::optional<Time> first_stamp;  ///< of the points
  std::optional<Time> last_stamp;
  std::vector<FramePose> frame_poses;        ///< of the frames that have one
  std::vector<SharedMotion> shared_motions;  ///< how shared errors move the returns, by place
};

}  // namespace thermovox
