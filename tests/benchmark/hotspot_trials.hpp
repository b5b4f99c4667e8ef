#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/simulate/simulation_options.hpp"

// Whether the error bars of hot spots are honest: the same small scene again and again, each time with other
// errors drawn from what the mission declares.
namespace thermovox::bench {

/// One joint of one trial against its truth.
struct JointTrial {
  bool found = false;
  double distance = 0.0;      ///< metres from the truth
  double mahalanobis2 = 0.0;  ///< of the position, chi squared with 3 degrees of freedom
  double random2 = 0.0;       ///< trace of the random part, m^2
  double common2 = 0.0;       ///< trace of the common part, m^2
  double peak_error = 0.0;    ///< C
  double peak_z = 0.0;        ///< in its sigmas, the camera's bias in them
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< world, metres
};

/// What two hot joints are on, 3 to 5.5 m beside a one-second flight.
enum class TrialScene {
  cabinet,  ///< the flat face of one
  pipes,    ///< two upright ones, 9 to 17 cm in radius, up to 35 degrees around from their front
};

/// The errors that a mission declares in a scene, by name.
struct ErrorSet {
  std::string name;
  simulate::DeclaredErrors errors;
  TrialScene scene = TrialScene::cabinet;
};

/// One flight past a scene drawn by the seed, seen by a turning laser and the camera of the simulated rig.
[[nodiscard]] std::vector<JointTrial> hotspotTrial(const ErrorSet& set, std::uint64_t seed);

/// Trials with the seeds from `first` on, on all processors.
[[nodiscard]] std::vector<JointTrial> hotspotTrials(const ErrorSet& set, std::uint64_t first,
                                                    std::size_t count);

/// What the trials say of the error bars.
struct TrialSummary {
  std::size_t joints = 0;
  std::size_t found = 0;
  double position_coverage = 0.0;  ///< share within the 95 % ellipsoid
  double position_nees = 0.0;      ///< mean squared Mahalanobis distance a degree of freedom
  double peak_coverage = 0.0;      ///< share within 1.96 sigmas
  double peak_nees = 0.0;          ///< mean squared error in sigmas
  double mean_distance = 0.0;      ///< metres
  double mean_peak_error = 0.0;    ///< C, absolute
};
[[nodiscard]] TrialSummary summaryOf(const std::vector<JointTrial>& trials);

/// Noise alone; pose; extrinsics and range bias; camera bias; noise alone on pipes; all of them.
[[nodiscard]] std::vector<ErrorSet> errorSets();

}  // namespace thermovox::bench
