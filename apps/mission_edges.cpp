#include "apps/mission_edges.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "calibration/depth_edges.hpp"

namespace thermovox {
namespace {

constexpr std::size_t kMostEdges = 500;  // of one frame; more are thinned out evenly

/// How much of a mission is compared: the shorter the time about a frame, the less do poses drift in it.
struct Gathering {
  std::int64_t frames = 80;
  Duration about_frame = std::chrono::milliseconds(120);
};

Gathering gatheringFor(LaserKind kind) {
  if (kind == LaserKind::scan) return {.about_frame = std::chrono::milliseconds(100)};
  if (kind == LaserKind::beam) return {.frames = 400, .about_frame = std::chrono::milliseconds(500)};
  return {};
}

/// The first frame in each of so many equal parts of the mission's time.
void chooseFrames(OpenedMission& opened, const ThermalCamera& camera, std::int64_t parts, EdgeScene& scene) {
  const auto poses = scene.trajectory.poses();
  const Time start = poses.front().stamp;
  const Duration part = std::max((poses.back().stamp - start) / parts, Duration(1));
  std::int64_t taken = -1;
  while (const std::optional<ThermalFrame> frame = opened.frames->next()) {
    if (frame->stamp < start || (frame->stamp - start) / part <= taken) continue;
    if (std::holds_alternative<NoPose>(scene.trajectory.at(frame->stamp))) continue;
    taken = (frame->stamp - start) / part;
    scene.frames.push_back({frame->stamp, thermalEdgesOf(*frame->image, camera.netd), {}});
  }
}

std::optional<PlacedEdge> placed(const DepthEdge& edge, const Trajectory& trajectory) {
  const auto near = trajectory.at(edge.near_stamp), past = trajectory.at(edge.past_stamp);
  if (std::holds_alternative<NoPose>(near) || std::holds_alternative<NoPose>(past)) return std::nullopt;
  return PlacedEdge{std::get<Pose>(near), std::get<Pose>(past), edge.near_laser, edge.past_laser};
}

/// Hands edges to the frames about them that see where they are.
class EdgeSorter {
 public:
  EdgeSorter(EdgeScene& scene, Duration about_frame) : scene_(scene), about_frame_(about_frame) {}

  [[nodiscard]] bool wants(Time stamp) const {
    return first(stamp - about_frame_) != first(stamp + about_frame_);
  }

  void add(const std::vector<DepthEdge>& edges) {
    for (const DepthEdge& edge : edges) {
      if (!wants(edge.near_stamp)) continue;
      const auto place = placed(edge, scene_.trajectory);
      if (!place) continue;
      const auto end = first(edge.near_stamp + about_frame_);
      for (auto frame = first(edge.near_stamp - about_frame_); frame != end; ++frame) {
        if (predictedEdge(scene_, *frame, *place, EdgeChange::Zero())) frame->edges.push_back(*place);
      }
    }
  }

 private:
  [[nodiscard]] std::vector<EdgeFrame>::iterator first(Time stamp) const {
    return std::lower_bound(scene_.frames.begin(), scene_.frames.end(), stamp,
                            [](const EdgeFrame& frame, Time time) { return frame.stamp < time; });
  }

  EdgeScene& scene_;
  Duration about_frame_;
};

/// A sweep's edges reach half a second beyond its stamp at most.
bool isNear(const EdgeSorter& sorter, const Reading& reading) {
  return !reading.returns.empty() &&
         (sorter.wants(reading.returns.front().stamp) || sorter.wants(reading.returns.back().stamp));
}

void gatherSweeps(OpenedMission& opened, std::size_t place, EdgeSorter& sorter) {
  const Laser& laser = opened.mission.rig.lasers[place];
  std::optional<Reading> before;
  while (std::optional<Reading> reading = opened.readings->next()) {
    if (reading->laser != place) continue;
    if (isNear(sorter, *reading)) {
      sorter.add(edgesWithin(*reading, laser));
      const bool successive = before && reading->stamp - before->stamp < std::chrono::milliseconds(150);
      if (laser.kind == LaserKind::scan && successive) sorter.add(edgesBetween(*before, *reading, laser));
    }
    before = std::move(reading);
  }
}

/// A beam's returns are few enough to be kept.
void gatherTrack(OpenedMission& opened, std::size_t place, EdgeSorter& sorter) {
  std::vector<LaserReturn> track;
  while (const std::optional<Reading> reading = opened.readings->next()) {
    if (reading->laser == place) track.insert(track.end(), reading->returns.begin(), reading->returns.end());
  }
  sorter.add(edgesAlong(track));
}

void thinOut(std::vector<PlacedEdge>& edges) {
  if (edges.size() <= kMostEdges) return;
  for (std::size_t i = 0; i < kMostEdges; ++i) edges[i] = edges[i * edges.size() / kMostEdges];
  edges.resize(kMostEdges);
}

}  // namespace

EdgeScene gatherEdges(OpenedMission& opened, const Rig& rig, std::size_t laser) {
  const ThermalCamera& camera = *rig.thermal_camera;
  const LaserKind kind = rig.lasers[laser].kind;
  const Gathering gathering = gatheringFor(kind);
  EdgeScene scene{.camera = camera.camera,
                  .T_body_camera = camera.T_body_camera,
                  .T_body_laser = rig.lasers[laser].T_body_laser,
                  .trajectory = opened.mission.trajectory,
                  .frames = {}};
  chooseFrames(opened, camera, gathering.frames, scene);
  EdgeSorter sorter(scene, gathering.about_frame);
  if (kind == LaserKind::beam) {
    gatherTrack(opened, laser, sorter);
  } else {
    gatherSweeps(opened, laser, sorter);
  }
  for (EdgeFrame& frame : scene.frames) thinOut(frame.edges);
  return scene;
}

}  // namespace thermovox
