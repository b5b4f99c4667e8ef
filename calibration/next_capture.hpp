#pragma once

#include <string>

#include "calibration/laser_verdict.hpp"
#include "projection/calibration_board.hpp"

namespace thermovox {

/// Which capture would tell most about a direction of the laser's pose that is known least: of boards tilted
/// in eight directions or not at all, at three distances, the one whose plane changes most in the laser's
/// ranges (in sigmas, a range bias that the capture may have apart) when the pose moves along it. A sentence
/// that begins with a verb.
[[nodiscard]] std::string adviseCapture(const Vector6d& weakest, const BundleData& data,
                                        const RigEstimate& estimate, double range_bias_sigma);

}  // namespace thermovox
