#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/rig_bundle.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// How far a point that the laser measures may come to lie beside its pixel in the reference camera, one
/// sigma: by the joint covariance of laser and lens, whose errors partly cancel.
struct PixelTransfer {
  double distance = 0.0;  ///< metres
  double sigma_px = 0.0;
};

/// What a calibration of the laser knows, and what it does not.
struct LaserVerdict {
  bool observable = false;
  std::string reason;  ///< why not; empty where it is
  bool roll_observable = true;
  /// Of T_reference_laser: R' = Exp(w) R, t' = t + v along the reference camera's axes (rad, m); of a beam
  /// without its roll, rank 5.
  Matrix6d covariance = Matrix6d::Zero();
  std::vector<PixelTransfer> transfer;
  double condition = 0.0;  ///< largest over least eigenvalue of the information in units of the tolerances
  Vector6d weakest = Vector6d::Zero();  ///< one sigma along what is known least, as in `covariance`
  std::string weakest_direction;        ///< the same in words, and which capture would help
  double weakest_share = 0.0;           ///< its sigma over what is tolerable (0.2 degrees, 5 mm)
  /// Of sigmas, leave-one-capture-out over the bundle's, the largest of six. Where it is more than few
  /// captures make it by chance, 2 n / (n - 2), something errs that is not modelled: `covariance` is then the
  /// bundle's times its square.
  double jackknife_ratio = 0.0;
  bool jackknife_wins = false;
  std::vector<std::string> warnings;
};

struct LaserVerdictInput {
  LaserKind kind = LaserKind::cloud;
  std::vector<int> free_intrinsics;  ///< of the reference camera
  int captures = 0;
};

/// The verdict by a bundle about its estimate and the covariance of all unknowns; words and warnings are left
/// to others. Precondition: there is a laser in it, and the covariance is not empty.
[[nodiscard]] LaserVerdict laserVerdict(const Linearisation& linear, const Eigen::MatrixXd& covariance,
                                        const RigEstimate& estimate, const LaserVerdictInput& input);

}  // namespace thermovox
