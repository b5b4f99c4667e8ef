#pragma once

#include <optional>
#include <vector>

#include "calibration/board_plane.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// The board of one capture as its images have it, and as the laser has it.
struct CaptureSight {
  Pose T_reference_board;
  /// Of it by the images alone: R' = Exp(w) R, t' = t + v along the reference camera's axes.
  Matrix6d covariance = Matrix6d::Zero();
  std::optional<PlaneMoments> plane;  ///< none: the laser has no board in this capture
};

/// Which captures the laser is calibrated from.
struct CaptureSelection {
  Pose T_reference_laser;         ///< by these captures
  double range_bias_sigma = 0.0;  ///< metres: what their ranges err by together
  std::vector<bool> counts;       ///< of each capture
  /// Of each capture with a plane: how likely noise alone would put its plane as far off. 1 without a plane.
  std::vector<double> probability;
};

/// Parts captures whose laser saw another board than the cameras (it moved in between) from the others. The
/// least fitting two fifths are left out, then the best fitting of those come back one at a time, as long as
/// their planes are as the others have it (Student's test and a chi-square at 5e-4). How much the ranges of a
/// capture err together is estimated anew each time, for the part that counts (a forward search: Atkinson and
/// Riani 2000; what remains of a Gaussian whose tails are cut off: Croux and Rousseeuw 1992). Each plane is
/// weighted by its own noise and by how well its images know the board. `start` should explain most captures.
[[nodiscard]] CaptureSelection selectCaptures(const std::vector<CaptureSight>& sights, LaserKind kind,
                                              const Pose& start);

}  // namespace thermovox
