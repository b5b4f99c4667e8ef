#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibration/corner_refinement.hpp"

namespace thermovox {

/// The board in one image: a corner for each of boardPoints(), in their order.
using BoardView = std::vector<BoardCorner>;

/// What all instruments saw of the board while it stood still. The laser's returns may be of many sweeps.
struct BoardCapture {
  std::string name;                             ///< for reports: the laser's file, else an image's
  std::vector<std::optional<BoardView>> views;  ///< one a camera, the reference camera first
  std::vector<Eigen::Vector3d> returns_laser;  ///< metres, laser frame, in the order of the file; may be none
};

}  // namespace thermovox
