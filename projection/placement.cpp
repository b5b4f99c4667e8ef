#include "projection/placement.hpp"

#include "projection/position_covariance.hpp"

namespace thermovox {

std::variant<PlacedReturn, NoPose> place(const LaserReturn& laser_return, const Laser& laser,
                                         const Mission& mission) {
  const std::variant<Pose, NoPose> at = mission.trajectory.at(laser_return.stamp);
  if (const NoPose* reason = std::get_if<NoPose>(&at)) return *reason;
  const Pose& T_world_body = std::get<Pose>(at);
  const PositionCovariance covariance =
      positionCovariance(mission, laser, T_world_body, laser_return.p_laser);
  return PlacedReturn{.stamp = laser_return.stamp,
                      .p_world = T_world_body * (laser.T_body_laser * laser_return.p_laser),
                      .origin_world = T_world_body * laser.T_body_laser.translation,
                      .range = laser_return.range(),
                      .rig_covariance = covariance.random + covariance.extrinsic,
                      .pose_covariance = covariance.pose};
}

}  // namespace thermovox
