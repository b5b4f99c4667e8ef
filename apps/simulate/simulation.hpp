#pragma once

#include <cstddef>
#include <vector>

#include "apps/simulate/flight.hpp"
#include "apps/simulate/hall.hpp"
#include "apps/simulate/simulation_options.hpp"
#include "projection/mission.hpp"

namespace thermovox::simulate {

/// What was drawn of the declared errors: the truth less what the files say.
struct DrawnErrors {
  Vector6d body_laser = Vector6d::Zero();  ///< rotation (radians), translation (metres), body's axes
  Eigen::Vector3d pose_rotation = Eigen::Vector3d::Zero();     ///< radians, world's axes
  Eigen::Vector3d pose_translation = Eigen::Vector3d::Zero();  ///< metres, world
  double range_bias = 0.0;                                     ///< metres: of what the laser says
  double camera_bias = 0.0;                                    ///< C: of what the camera shows
};

/// A flight with everything that is true of it: what the files will say and what really is.
class Simulation {
 public:
  /// Through the hall of the options' seed. Throws ConfigError when an option cannot be used.
  explicit Simulation(const SimulationOptions& options);
  /// Through another one.
  Simulation(const SimulationOptions& options, const Hall& hall);

  [[nodiscard]] const SimulationOptions& options() const { return options_; }
  [[nodiscard]] const Hall& hall() const { return hall_; }

  /// The rig as its file tells it.
  [[nodiscard]] const Rig& rig() const { return rig_; }
  /// Poses as the trajectory's file tells them; they reach 0.05 s beyond the measurements on both sides.
  [[nodiscard]] std::vector<StampedPose> writtenPoses() const;

  /// The true pose of the body, which differs from the written one by the pose's drawn error.
  [[nodiscard]] Pose truePose(Time stamp) const;
  [[nodiscard]] const Pose& trueBodyLaser() const { return T_body_laser_; }
  [[nodiscard]] const DrawnErrors& drawnErrors() const { return errors_; }

  /// Thermal frames and sweeps of the laser that the flight has, and their stamps.
  [[nodiscard]] std::size_t frameCount() const;
  [[nodiscard]] Time frameStamp(std::size_t frame) const;
  [[nodiscard]] std::size_t sweepCount() const;
  [[nodiscard]] Time sweepStamp(std::size_t sweep) const;

 private:
  SimulationOptions options_;
  Hall hall_;
  Flight flight_;
  Rig rig_;
  Pose T_body_laser_;
  DrawnErrors errors_;
};

}  // namespace thermovox::simulate
