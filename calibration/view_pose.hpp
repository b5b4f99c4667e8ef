#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/board_capture.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// The board's pose T_camera_board by one view of it and a camera that is about known: the better of the two
/// answers for a plane (IPPE, Collins and Bartoli 2014, in OpenCV). It is a start for the bundle, not a
/// result. None where fewer than four corners have a ray or the board would lie behind the camera.
[[nodiscard]] std::optional<Pose> poseFromView(const std::vector<Eigen::Vector3d>& points,
                                               const BoardView& view, const Camera& camera);

}  // namespace thermovox
