#pragma once

#include <string>
#include <vector>

#include "calibration/edge_alignment.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// What a mission says of the rig that measured it.
struct MissionRefinement {
  int frames = 0;  ///< in which edges were compared
  int edges = 0;   ///< depth edges beside which the images have an edge of temperature
  /// Of the distance between them, a pixel's 4 or more apart not counted, by robust weights; as the rig is,
  /// and after the change.
  double rms_px = 0.0;
  double rms_px_refined = 0.0;
  EdgeChange change = EdgeChange::Zero();  ///< the estimate, what is not significant of it included
  EdgeChange sigma = EdgeChange::Zero();   ///< its standard deviations
  /// The part of the change that is significant, and 0 where the mission gives no reason to change the rig.
  EdgeChange applied = EdgeChange::Zero();
  bool refined = false;    ///< `applied` moves the laser
  bool consistent = true;  ///< edges agree, and nothing is to be changed, the stamps included
  Pose T_body_laser;       ///< with `applied`
  Matrix6d covariance_body_laser = Matrix6d::Zero();  ///< of that pose; a beam's without its roll, rank 5
  double lock =
      0.0;  ///< with `change`: how well edges agree, over what they do by chance (edge_agreement.hpp)
  double gain = 0.0;        ///< of the robust cost, on stretches that the fit had not seen, as a share of it
  double gain_sigma = 0.0;  ///< by the stretches' spread
  std::vector<std::string> undetermined;  ///< of rotation_x .. translation_z and time_offset
  std::vector<std::string> warnings;
};

/// Checks, by the consistency of depth edges with edges of temperature, where the laser is in respect of the
/// camera and when frames were taken, and proposes a change where the mission gives good reason for one: the
/// change is significant, and stretches of the mission that had no part in its estimation are the better for
/// it. `laser` gives the covariance that is known before; where it is zero, two degrees and 3 cm are taken.
/// Throws UnobservableError where there are too few edges to say anything.
[[nodiscard]] MissionRefinement refineOnMission(const EdgeScene& scene, const Laser& laser);

}  // namespace thermovox
