#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "apps/simulate/simulation.hpp"

namespace thermovox::simulate {

/// The truth file's text (JSON): laser, seed, readings (laser echoes written), duration (seconds), boxes
/// [low, high, Celsius], cyls [x, y, radius, top, Celsius], size [L, W, H], warmer (C, of floor and walls;
/// not there where 0), hotspots {position, delta, sigma, peak}, the true T_body_laser, and what was drawn of
/// the declared errors: pose_error {rotation, translation} (at every moment R = Exp(rotation) R_written, t =
/// t_written + translation), range_bias (in every range) and camera_bias (in every temperature); world frame,
/// metres, radians and Celsius.
[[nodiscard]] std::string truthText(const Simulation& simulation, std::size_t readings);

/// The hall of such a file, whoever wrote it. Throws DataError naming the file when it cannot be read or a
/// key is missing or of another form.
[[nodiscard]] Hall readTrueHall(const std::filesystem::path& file);

}  // namespace thermovox::simulate
