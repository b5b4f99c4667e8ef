#pragma once

#include <optional>

#include "projection/local_variance.hpp"
#include "projection/pose.hpp"
#include "projection/projector.hpp"
#include "projection/rig.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// A temperature read between the pixels of a frame.
struct TemperatureSample {
  float celsius = 0.0F;
  float noise_sigma = 0.0F;  ///< NETD after averaging: netd * sqrt(sum of the squared weights), C
};

/// The least share of a sample's bilinear weight that must lie on known pixels.
inline constexpr float kLeastKnownWeight = 0.5F;

/// Bilinear sample of the image at a pixel (centres at whole numbers). Pixels that are NaN or outside do not
/// take part, the others share their weight; nullopt where less than kLeastKnownWeight is left.
[[nodiscard]] std::optional<TemperatureSample> sampleTemperature(const ThermalImage& image,
                                                                 const Eigen::Vector2d& pixel, double netd);

/// A thermal frame with all that colouring needs of it: where the camera was, what it saw, and how much that
/// varies from pixel to pixel.
struct ThermalView {
  ThermalFrame frame;
  Pose T_world_camera;
  Pose T_camera_world;
  Projector projector;  ///< world to pixel
  double noise;  ///< of one pixel of this frame, one sigma, C: the camera's, raised as its temperatures are
  LocalVariance local_variance;

  /// T_world_camera is the camera's pose at the frame's own time.
  ThermalView(ThermalFrame thermal_frame, const Pose& camera_in_world, const ThermalCamera& camera);
};

}  // namespace thermovox
