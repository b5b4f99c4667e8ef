#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "io/map_view.hpp"
#include "io/report_pictures.hpp"
#include "io/spot_images.hpp"
#include "mapping/hotspot.hpp"

namespace thermovox {

/// A place to be marked in a map, and its number.
struct MapMark {
  int id = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< metres
};

/// SVG of a map with its scale and the marks, each with its number as a link to "#spot-ID". Numbers evade one
/// another. Marks are drawn over everything, hidden or not.
[[nodiscard]] std::string mapDrawing(const MapView& drawn, std::span<const MapMark> marks,
                                     const std::string& label);

/// SVG of a hot spot's surroundings with its 95 % ellipsoid, a bar of a round length and the scale.
[[nodiscard]] std::string spotDrawing(const SpotPicture& drawn, const Hotspot& spot,
                                      const std::string& label);

/// SVG of a part of a camera's image with a ring about the spot, and the scale of a thermal one.
[[nodiscard]] std::string cropDrawing(const FrameCrop& crop, const std::string& label);

}  // namespace thermovox
