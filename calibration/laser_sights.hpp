#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/calibration_input.hpp"
#include "calibration/laser_start.hpp"

namespace thermovox {

/// Where in a cloud a board is sought: within 11 degrees of where the guess has it, or anywhere. Beams and
/// scans are searched whole at once.
enum class SearchWhere { near_guess, anywhere };

/// What may be the board in each capture's returns. Captures without a view have none.
[[nodiscard]] std::vector<LaserSight> laserSights(
    const CalibrationInput& input, const std::vector<BoardCapture>& captures,
    const std::vector<Pose>& T_reference_board, SearchWhere where,
    const std::function<void(const std::string& stage, double done)>& progress);

}  // namespace thermovox
