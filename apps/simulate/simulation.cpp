#include "apps/simulate/simulation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "apps/simulate/hall_layout.hpp"
#include "apps/simulate/random.hpp"
#include "apps/simulate/simulated_rig.hpp"

namespace thermovox::simulate {
namespace {

constexpr double kPoseMargin = 0.05;   // seconds of poses before the first and after the last measurement
constexpr double kFirstFrame = 0.013;  // seconds: frames do not fall on poses or sweeps

SimulationOptions validated(const SimulationOptions& options) {
  options.validate();
  return options;
}

/// A draw of N(0, covariance); the symmetric root also takes a covariance of lower rank.
Vector6d drawMotion(const Matrix6d& covariance, Random& random) {
  Vector6d unit;
  for (double& value : unit) value = random.normal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(covariance);
  const Vector6d roots = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return eigen.eigenvectors() * roots.asDiagonal() * eigen.eigenvectors().transpose() * unit;
}

DrawnErrors drawErrors(const SimulationOptions& options) {
  const DeclaredErrors& declared = options.errors;
  Random random(options.seed, RandomStream::errors);
  DrawnErrors drawn;
  drawn.body_laser = drawMotion(declared.covariance_body_laser, random);
  drawn.pose_rotation = declared.pose_rotation_sigma * random.normal3();
  drawn.pose_translation = declared.pose_translation_sigma * random.normal3();
  drawn.range_bias = declared.range_bias_sigma * random.normal();
  drawn.camera_bias = declared.camera_bias_sigma * random.normal();
  return drawn;
}

FlightStyle usualFlight(LaserKind laser) {
  return laser == LaserKind::cloud ? FlightStyle::along_aisle : FlightStyle::facing_rows;
}

double sweepRate(const SimulationOptions& options) {
  switch (options.laser) {
    case LaserKind::beam:
      return options.beam_rate;
    case LaserKind::scan:
      return options.scan_rate;
    case LaserKind::cloud:
      break;
  }
  return options.cloud_rate;
}

std::size_t countOf(double duration, double rate) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::floor(duration * rate + 1e-9)));
}

}  // namespace

Simulation::Simulation(const SimulationOptions& options)
    : Simulation(options, makeHall(options.hall_seed.value_or(options.seed))) {}

Simulation::Simulation(const SimulationOptions& options, const Hall& hall)
    : options_(validated(options)),
      hall_(hall.changed(options.changes)),
      flight_(hall_, options.flight.value_or(usualFlight(options.laser)), options.duration, options.seed),
      rig_(makeRig(options_)),
      T_body_laser_(rig_.lasers.front().T_body_laser),
      errors_(drawErrors(options_)) {
  if (errors_.body_laser.isZero(0.0)) return;
  T_body_laser_.rotation = (expRotation(errors_.body_laser.head<3>()) * T_body_laser_.rotation).normalized();
  T_body_laser_.translation += errors_.body_laser.tail<3>();
}

std::vector<StampedPose> Simulation::writtenPoses() const {
  const double end = options_.duration + 1.0 / sweepRate(options_);
  return flight_.sample(-kPoseMargin, end + kPoseMargin, options_.pose_rate);
}

Pose Simulation::truePose(Time stamp) const {
  const Pose written = flight_.at(stamp);
  return {(expRotation(errors_.pose_rotation) * written.rotation).normalized(),
          written.translation + errors_.pose_translation};
}

std::size_t Simulation::frameCount() const {
  return countOf(options_.duration, options_.frame_rate);
}

Time Simulation::frameStamp(std::size_t frame) const {
  return Flight::kStart + durationFromSeconds(kFirstFrame + static_cast<double>(frame) / options_.frame_rate);
}

std::size_t Simulation::sweepCount() const {
  return countOf(options_.duration, sweepRate(options_));
}

Time Simulation::sweepStamp(std::size_t sweep) const {
  return Flight::kStart + durationFromSeconds(static_cast<double>(sweep) / sweepRate(options_));
}

}  // namespace thermovox::simulate
