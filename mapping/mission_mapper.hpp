#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapping/thermal_map.hpp"
#include "projection/colouring.hpp"
#include "projection/depth_sectors.hpp"
#include "projection/mission.hpp"
#include "projection/sources.hpp"

namespace thermovox {

/// A return as it enters the map: placed, and coloured where a frame saw it.
struct ColouredReturn {
  PlacedReturn placed;
  std::optional<Colour> colour;
};

/// What became of a mission's returns. points = coloured + the sum of uncoloured; dropped ones never entered
/// the map.
struct MissionReport {
  std::string mission;
  std::size_t readings = 0;  ///< sweeps: single ranges, scan lines or clouds
  std::size_t points = 0;
  std::size_t coloured = 0;
  std::map<std::string, std::size_t> uncoloured;  ///< by reason
  std::map<std::string, std::size_t> dropped;     ///< by reason
  std::size_t frames = 0;
  std::size_t frames_without_pose = 0;
  std::optional<Time> first_stamp;  ///< of the points
  std::optional<Time> last_stamp;
};

/// The one way from readings and frames to the map, for folders, bags and instruments alike.
///
/// A return takes its temperature from the frame nearest in time that sees it. To know what stands before a
/// point, a frame first waits for `lookahead` of laser data after it; then what the map holds and what is
/// still waiting decide (DepthSectors). So readings enter the map with a delay of lookahead + frame limit,
/// and the memory in use is bounded by that delay, whatever the length of the mission. All decisions go by
/// stamps alone: the result does not depend on when the data arrive, only on their order by stamp.
class MissionMapper {
 public:
  struct Options {
    Carving carving = Carving::octomap;
    /// Farthest in time that a frame may be from the return it colours; zero: half a frame period + 50 ms.
    Duration frame_limit = Duration::zero();
    /// Laser data after a frame that its visibility waits for.
    Duration lookahead = std::chrono::milliseconds(500);
    DepthSectors::Options visibility;
    void validate() const;  ///< throws ConfigError naming the field
  };
  /// Receives every return that entered the map, readings in the order of their stamps.
  using Sink = std::function<void(std::span<const ColouredReturn> reading)>;

  /// The mission must outlive the mapper. `frame_period` is the usual time from frame to frame (zero:
  /// unknown).
  MissionMapper(const Mission& mission, ThermalMap& map, Duration frame_period, const Options& options,
                Sink sink = {});
  ~MissionMapper();

  /// Frames and readings are to be added in ascending order of their stamps, the two merged.
  void add(ThermalFrame frame);
  void add(Reading reading);
  /// Maps what is still waiting and returns the account. To be called once, last.
  /// Throws DataError when no return entered the map: the trajectory covers none, or none was valid.
  [[nodiscard]] MissionReport finish();

 private:
  struct WaitingFrame;
  struct WaitingReading;
  void advanceTo(Time now);
  void closeFrame(WaitingFrame& frame);
  void mapReading(const WaitingReading& reading);
  [[nodiscard]] ColouredReturn colourReturn(const PlacedReturn& placed);
  void dropOldFrames(Time before);
  [[nodiscard]] Time dueTime(const WaitingFrame& frame) const;
  [[nodiscard]] Time dueTime(const WaitingReading& reading) const;

  const Mission& mission_;
  ThermalMap& map_;
  Options options_;
  Sink sink_;
  MissionReport report_;
  std::deque<std::unique_ptr<WaitingFrame>> frames_;  ///< ascending; the closed ones first
  std::size_t closed_frames_ = 0;
  std::deque<std::unique_ptr<WaitingReading>> readings_;
};

/// Feeds a whole mission through a mapper, frames and readings merged by stamp. `frames` may be null.
/// `progress` is called after every reading with its stamp.
[[nodiscard]] MissionReport mapMission(const Mission& mission, ReadingSource& readings, FrameSource* frames,
                                       ThermalMap& map, const MissionMapper::Options& options,
                                       MissionMapper::Sink sink = {},
                                       const std::function<void(Time)>& progress = {});

}  // namespace thermovox
