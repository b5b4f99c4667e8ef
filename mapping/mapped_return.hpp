#pragma once

#include <Eigen/Core>
#include <optional>

#include "mapping/surface_cell.hpp"
#include "projection/time.hpp"

namespace thermovox {

/// One laser return as the map takes it: where it lies, whence it was seen, and how warm it is.
struct MappedReturn {
  Eigen::Vector3d p_world;       ///< metres
  Eigen::Vector3d origin_world;  ///< where the laser was at that moment, metres
  Time stamp;
  std::optional<TemperatureObservation> temperature;  ///< none where no frame saw the point
};

/// Which cells a ray frees.
enum class Carving {
  none,     ///< none: surfaces only
  octomap,  ///< every cell between the laser and the return, as OctoMap's insertPointCloud does
  /// As octomap, but no cell that a return of the same mission hit, and none beside a cell that the same
  /// reading hits: rays that graze a floor or a wall do not erase it. A cell that is hit for the first time
  /// counts as no less than undecided before, whatever rays grazed it. What moves away during a mission
  /// stays in that mission's map; the next mission's rays free it.
  careful,
};

/// The word that names it on the command line and in a station.
[[nodiscard]] constexpr const char* nameOf(Carving carving) {
  return carving == Carving::none ? "none" : (carving == Carving::octomap ? "octomap" : "careful");
}

}  // namespace thermovox
