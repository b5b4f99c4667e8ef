#pragma once

#include "calibration/rig_bundle.hpp"

namespace thermovox::test {

/// An estimate, moved along the tangent as rig_bundle.hpp and pose_manifold.hpp say it, written anew here.
inline RigEstimate movedBy(RigEstimate estimate, const TangentLayout& layout, const Eigen::VectorXd& tangent,
                           const BundleModel& model) {
  const auto leftMoved = [&](Pose& pose, int place) {
    if (place < 0) return;
    pose = {(expRotation(tangent.segment<3>(place)) * pose.rotation).normalized(),
            pose.translation + tangent.segment<3>(place + 3)};
  };
  if (layout.laser_size > 0) {
    const int turns = layout.laser_size - 3;
    Eigen::Vector3d w = Eigen::Vector3d::Zero();
    w.tail(turns) = tangent.segment(layout.laser, turns);
    Pose& laser = estimate.T_reference_laser;
    laser = {(laser.rotation * expRotation(w)).normalized(),
             laser.translation + tangent.segment<3>(layout.laser + turns)};
  }
  for (std::size_t camera = 0; camera < estimate.cameras.size(); ++camera) {
    const std::vector<int>& free = model.free_intrinsics[camera];
    for (std::size_t i = 0; i < free.size() && layout.intrinsics[camera] >= 0; ++i) {
      estimate.cameras[camera].parameters[static_cast<std::size_t>(free[i])] +=
          tangent[layout.intrinsics[camera] + static_cast<Eigen::Index>(i)];
    }
    leftMoved(estimate.T_camera_reference[camera], layout.camera_pose[camera]);
  }
  if (layout.common_bias >= 0) estimate.common_range_bias += tangent[layout.common_bias];
  if (layout.edge_bias >= 0) estimate.edge_bias += tangent[layout.edge_bias];
  for (std::size_t i = 0; i < estimate.T_reference_board.size(); ++i) {
    if (layout.range_bias[i] >= 0) estimate.range_bias[i] += tangent[layout.range_bias[i]];
    leftMoved(estimate.T_reference_board[i], layout.board[i]);
  }
  return estimate;
}

}  // namespace thermovox::test
