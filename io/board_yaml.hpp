#pragma once

#include "io/yaml_map.hpp"
#include "projection/calibration_board.hpp"

namespace thermovox {

/// The calibration board that a mapping describes: `pattern`, `inner_corners` (of circles also `circles`),
/// `square`, and, where the plate is known, either `margin` around the pattern or `width` and `height`. The
/// pattern of a chessboard is its squares, that of circles their middles. Throws ConfigError naming the key
/// that is missing, unknown or impossible: a plate that is smaller than its pattern, and a chessboard with as
/// many rows as columns on a plate that is not square, whose pose would be anybody's guess by a quarter turn.
[[nodiscard]] CalibrationBoard readBoard(const YamlMap& map);

}  // namespace thermovox
