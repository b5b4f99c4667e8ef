#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "projection/calibration_board.hpp"

namespace thermovox {

/// Reads the corners (or the middles of the circles) of a board that somebody has marked in an image by hand:
/// a CSV file `u,v`, pixels, one corner a row, row by row of the board. Throws DataError naming file and
/// line: not two finite numbers, not as many rows as the board has corners. `named_by` says who wants the
/// file.
[[nodiscard]] std::vector<Eigen::Vector2d> readCorners(const std::filesystem::path& file,
                                                       const CalibrationBoard& board,
                                                       std::string_view named_by = {});

/// The same from a stream; `name` stands for it in messages.
[[nodiscard]] std::vector<Eigen::Vector2d> readCorners(std::unique_ptr<std::istream> stream,
                                                       const std::string& name,
                                                       const CalibrationBoard& board);

}  // namespace thermovox
