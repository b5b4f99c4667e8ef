#pragma once

#include <cstddef>
#include <optional>

#include "mapping/scene_view.hpp"
#include "mapping/thermal_map.hpp"
#include "projection/rig.hpp"
#include "projection/thermal_view.hpp"

namespace thermovox {

/// The farthest that a frame paints, metres: there a pixel is as wide as four cells, and beyond it says
/// little of any of them.
[[nodiscard]] double paintRange(const ThermalCamera& camera, double resolution);

/// What painting is told of the mission.
struct PaintOptions {
  double range_sigma = 0.0;       ///< noise of the laser that measured the surfaces, one sigma, metres
  std::optional<double> ambient;  ///< of the air, C: what surfaces mirror, where the frame does not say
};

/// Paints a frame onto a map: every surface of the scene within paintRange that nothing hides from the frame
/// gets one observation in its cell of `map`, at the mean position of the cell's returns. Its sigma is that
/// of a laser point whose position is unsure by range_sigma and by the spread of a surface within
/// its cell (edge^2 / 12 an axis): a cell on an edge of temperatures, or wider than a pixel, distrusts
/// itself. The incidence is that on the plane of the neighbouring cells, and what a grazing one is worth is
/// the observation's common sigma (GrazingView). Cells that one pixel paints share its noise; a cell gets at
/// most one observation from a frame.
std::size_t paint(const ThermalView& view, const ThermalCamera& camera, const SceneView& scene_view,
                  const PaintOptions& options, ThermalMap& map);

}  // namespace thermovox
