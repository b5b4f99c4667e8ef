#pragma once

#include <memory>
#include <span>

#include "io/mission_folder.hpp"
#include "io/visible_edges.hpp"
#include "io/visible_frames.hpp"

namespace thermovox {

/// The visible pictures of a mission on its thermal frames, by the rig, the poses and the laser's points.
class MissionPictures {
 public:
  /// The mission, which has to have a thermal and a visible camera and visible pictures, must outlive it. A
  /// picture belongs to a frame at most `within` away in time.
  MissionPictures(const OpenedMission& opened, Duration within);

  /// The picture nearest in time to the frame, brought onto its pixels: each by the distance of the laser
  /// point that is nearest in the image. `points_world`: those that the frame sees, metres. Null where no
  /// picture is near in time or the trajectory has no pose. Frames have to ascend from call to call. Throws
  /// DataError as VisibleFrames::nearest does.
  [[nodiscard]] std::shared_ptr<const RegisteredPicture> on(Time frame,
                                                            std::span<const Eigen::Vector3d> points_world);

 private:
  const Mission& mission_;
  VisibleFrames pictures_;
  Duration within_;
};

}  // namespace thermovox
