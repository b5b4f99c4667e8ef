#pragma once

#include <optional>
#include <vector>

#include "projection/pose.hpp"
#include "projection/rig.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// A temperature read between the pixels of a frame.
struct TemperatureSample {
  float celsius = 0.0F;
  float noise_sigma = 0.0F;  ///< NETD after averaging: netd * sqrt(sum of the squared weights), C
};

/// Bilinear sample of the image at a pixel (centres at whole numbers). Pixels that are NaN or outside do not
/// take part, the others share their weight; nullopt where less than half of the weight is left.
[[nodiscard]] std::optional<TemperatureSample> sampleTemperature(const ThermalImage& image,
                                                                 const Eigen::Vector2d& pixel, double netd);

/// How much the temperature varies around every pixel, as the variance (C^2) that a position error of a given
/// size makes of it: the image's variance under a Gaussian window, without what the camera's noise alone
/// would show. One level per window; between the levels the variance is linear in the window's variance,
/// which for a constant gradient g is exactly |g|^2 s^2.
class LocalVariance {
 public:
  /// `blur_px` is the smallest window: optics and pixel mix that neighbourhood in any case, and at least the
  /// width of a pixel.
  LocalVariance(const ThermalImage& image, double blur_px, double netd);

  /// Variance (C^2) at the pixel for an error of `variance_px2` (px^2 an axis) beyond the blur.
  [[nodiscard]] float at(const Eigen::Vector2d& pixel, double variance_px2) const;

 private:
  struct Level {
    double window_px2 = 0.0;  ///< variance of the window, px^2
    std::vector<float> variance;
  };
  int width_ = 0;
  int height_ = 0;
  std::vector<Level> levels_;
};

/// A thermal frame with all that colouring needs of it: where the camera was, what it saw, and how much that
/// varies from pixel to pixel.
struct ThermalView {
  ThermalFrame frame;
  Pose T_world_camera;
  Pose T_camera_world;
  LocalVariance local_variance;

  /// T_world_camera is the camera's pose at the frame's own time.
  ThermalView(ThermalFrame thermal_frame, const Pose& camera_in_world, const ThermalCamera& camera);
};

}  // namespace thermovox
