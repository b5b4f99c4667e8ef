#include "projection/position_covariance.hpp"

namespace thermovox {
namespace {

/// A Sigma A^T for A = [-[lever]x, I], the motion of a point at `lever` under (w, v).
Eigen::Matrix3d movedByRigidMotion(const Eigen::Vector3d& lever, const Matrix6d& covariance) {
  Eigen::Matrix<double, 3, 6> A;
  A.leftCols<3>() = -skew(lever);
  A.rightCols<3>().setIdentity();
  return A * covariance * A.transpose();
}

Matrix6d isotropic(double rotation_sigma, double translation_sigma) {
  Vector6d variances;
  variances.head<3>().setConstant(rotation_sigma * rotation_sigma);
  variances.tail<3>().setConstant(translation_sigma * translation_sigma);
  return variances.asDiagonal();
}

}  // namespace

PositionCovariance positionCovariance(const Mission& mission, const Laser& laser, const Pose& T_world_body,
                                      const Eigen::Vector3d& p_laser) {
  const Eigen::Vector3d lever_body = laser.T_body_laser.rotation * p_laser;
  const Eigen::Vector3d d_world = T_world_body.rotation * lever_body.normalized();
  const Eigen::Matrix3d along_ray = d_world * d_world.transpose();

  PositionCovariance covariance;
  covariance.random = laser.range_sigma * laser.range_sigma * along_ray;
  covariance.extrinsic = laser.range_bias_sigma * laser.range_bias_sigma * along_ray;
  if (!laser.covariance_body_laser.isZero(0.0)) {
    const Eigen::Matrix3d R_world_body = T_world_body.matrix();
    covariance.extrinsic +=
        R_world_body * movedByRigidMotion(lever_body, laser.covariance_body_laser) * R_world_body.transpose();
  }
  if (mission.pose_rotation_sigma > 0.0 || mission.pose_translation_sigma > 0.0) {
    const Eigen::Vector3d lever_world = T_world_body.rotation * (lever_body + laser.T_body_laser.translation);
    covariance.pose = movedByRigidMotion(
        lever_world, isotropic(mission.pose_rotation_sigma, mission.pose_translation_sigma));
  }
  return covariance;
}

}  // namespace thermovox
