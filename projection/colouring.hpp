#pragma once

#include <variant>

#include "projection/occluder.hpp"
#include "projection/placement.hpp"
#include "projection/thermal_view.hpp"

namespace thermovox {

/// The temperature of a point as one frame saw it.
struct Colour {
  Time frame_stamp;       ///< of the frame that saw it
  Eigen::Vector2d pixel;  ///< where the point projects
  float celsius = 0.0F;
  /// One standard deviation, C, of all but the camera's common bias:
  ///   sigma^2 = netd^2 sum(w^2) + V(pixel, S_uv)
  /// with w the bilinear weights, S_uv = J Sigma J^T the pixel covariance of the point's position error and V
  /// the temperature's local variance for an error of that size on top of the optics' blur. Where the air on
  /// the way to the point is put into the temperature (ThermalImage::air), times what it does to differences.
  float sigma = 0.0F;
  float range = 0.0F;  ///< camera to point, metres
};

/// Why a frame gives a point no temperature; unknown_pixel also where none fits what the camera counted.
enum class NoColour { outside_image, hidden, unknown_pixel };

/// Colours one point by one frame: projects it into the camera where the camera was when the frame was
/// taken, asks whether anything stands before it, reads the temperature between the pixels and says how far
/// it can be trusted.
[[nodiscard]] std::variant<Colour, NoColour> colour(const PlacedReturn& point, const ThermalView& view,
                                                    const ThermalCamera& camera, const Occluder& occluder);

}  // namespace thermovox
