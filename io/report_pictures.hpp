#pragma once

#include <Eigen/Core>
#include <string>

#include "io/map_view.hpp"
#include "mapping/hotspot.hpp"
#include "mapping/surface_layer.hpp"

namespace thermovox {

/// A picture of a report.
struct ReportPicture {
  std::string png;
  int width_px = 0;
  int height_px = 0;
  TemperatureScale scale;
};

[[nodiscard]] ReportPicture pictureOf(const MapView& drawn);

/// The surroundings of a hot spot by the temperatures of one mission's map: there is no image that it could
/// be cut out of, as a station keeps none.
struct SpotPicture {
  ReportPicture picture;
  bool along_normal = true;  ///< seen along the normal of the surface; false: along +y, as it is not known
  double half_width = 0.0;   ///< metres from its middle, the spot's position, to its edge
  /// Pixels to the right and down of a metre along each axis of the world.
  Eigen::Matrix<double, 2, 3> px_from_world = Eigen::Matrix<double, 2, 3>::Zero();
};

/// Every pixel is a mean of the cells around it, the nearer weighing more, of those that lie foremost; where
/// there is none it stays light grey. What stands further in front of the surface than the spot is large (and
/// than 25 cm) is left out.
[[nodiscard]] SpotPicture drawSpot(const Hotspot& spot, const SurfaceLayer& layer);

}  // namespace thermovox
