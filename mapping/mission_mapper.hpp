#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mapping/frame_window.hpp"
#include "mapping/mission_report.hpp"
#include "mapping/scene_view.hpp"
#include "mapping/thermal_map.hpp"
#include "projection/depth_sectors.hpp"
#include "projection/mission.hpp"
#include "projection/sources.hpp"

namespace thermovox {

/// A return as it enters the map: placed, and coloured where a frame saw it.
struct ColouredReturn {
  PlacedReturn placed;
  std::optional<Colour> colour;
};

/// The one way from readings and frames to the map, for folders, bags and instruments alike.
///
/// A return takes its temperature from the frame nearest in time that sees it. To know what stands before a
/// point, a frame first waits for `lookahead` of laser data after it; then what the map holds and what is
/// still waiting decide (DepthSectors). So readings enter the map with a delay of lookahead + frame limit +
/// their own length, and the memory in use is bounded by that delay, whatever the length of the mission. All
/// decisions go by stamps alone: the result does not depend on when the data arrive, only on their order by
/// stamp.
///
/// Returns that one pixel of one frame colours share its noise, so that the map takes the k-th of them with k
/// times its sigma: together they weigh less than 1.65 of the first. What the angle of the view costs a
/// temperature (GrazingView) is told apart, as no noise; the sink's colours have all in their sigmas.
///
/// Mapped in two passes, a mission's geometry comes first (mapMission without frames, into the same map). The
/// second pass adds no geometry: it tests the colours against the whole scene (SceneView), and may paint
/// every frame onto all of the scene that it sees.
class MissionMapper {
 public:
  /// What a mapper brings into the map.
  enum class Pass {
    only,     ///< geometry and colours, as they come
    colours,  ///< the second of two: the mission's geometry is in the map and in the scene
    paint,    ///< likewise, and frames instead of returns give the map its temperatures
  };
  struct Options {
    Carving carving = Carving::careful;
    /// Farthest in time that a frame may be from the return it colours. Zero: half a frame period + 50 ms
    /// where the period is known (mapMission), 50 ms where not.
    Duration frame_limit = Duration::zero();
    /// Laser data after a frame that its visibility waits for; at least the frame limit is taken.
    Duration lookahead = std::chrono::milliseconds(500);
    DepthSectors::Options visibility;
    Pass pass = Pass::only;
    /// Geometry that hides things besides what the mapper itself has mapped; must outlive it. The second pass
    /// needs one that holds the map itself.
    SceneSurfaces* scene = nullptr;
    SceneView::Options scene_visibility;
    void validate() const;  ///< throws ConfigError naming the field
  };
  /// Receives every return that entered the map, readings in the order of their stamps.
  using Sink = std::function<void(std::span<const ColouredReturn> reading)>;

  /// Mission and map must outlive the mapper.
  MissionMapper(const Mission& mission, ThermalMap& map, const Options& options, Sink sink = {});
  ~MissionMapper();

  /// Frames and readings are to be added in ascending order of their stamps, the two merged. Throws
  /// ConfigError for a frame when the rig has no thermal camera, or a reading of a laser it does not have.
  void add(ThermalFrame frame);
  void add(Reading reading);
  /// Maps what is still waiting and returns the account. To be called once, last.
  /// Throws DataError when no return entered the map: the trajectory covers none, or none was valid.
  [[nodiscard]] MissionReport finish();

 private:
  struct WaitingReading;
  void advanceTo(Time now);
  void closeFrame();
  [[nodiscard]] std::unique_ptr<Occluder> occluderFor(const ThermalView& view);
  [[nodiscard]] std::unique_ptr<Occluder> secondLook(const ThermalView& view);
  /// How far a frame looks for surfaces, metres: to the farthest return that may ask it, and as far as it
  /// paints, because what stands behind a point tells that nothing stands before it.
  [[nodiscard]] double viewRange(const ThermalView& view) const;
  void countPainted();
  void mapReading(const WaitingReading& reading);
  /// Of the coloured points: from the scene, where it is known, else from one another.
  [[nodiscard]] std::vector<Eigen::Vector3f> normalsOf(
      std::span<const PlacedReturn> returns, std::span<const std::optional<FrameColour>> found) const;
  void addToMap(std::span<const MappedReturn> reading);
  [[nodiscard]] std::optional<FrameColour> counted(const std::variant<FrameColour, Uncoloured>& answer);
  [[nodiscard]] Time earliestWaiting(Time now) const;

  const Mission& mission_;
  ThermalMap& map_;
  Options options_;
  Sink sink_;
  MissionReport report_;
  DroppedCounts dropped_;
  UncolouredCounts uncoloured_;
  std::optional<FrameWindow> frames_;  ///< none without a thermal camera
  std::deque<WaitingReading> readings_;
};

/// A mission with its streams; `frames` may be null.
struct MissionStreams {
  const Mission& mission;
  ReadingSource& readings;
  FrameSource* frames = nullptr;
};

/// Who wants to hear of a mission while it is mapped; each may be empty.
struct MissionListeners {
  MissionMapper::Sink points;
  std::function<void(Time)> progress;  ///< after every reading, with its stamp
};

/// Feeds a whole mission through a mapper, frames and readings merged by stamp.
[[nodiscard]] MissionReport mapMission(const MissionStreams& streams, ThermalMap& map,
                                       MissionMapper::Options options,
                                       const MissionListeners& listeners = {});

}  // namespace thermovox
