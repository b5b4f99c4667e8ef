#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "projection/projector.hpp"

namespace thermovox {

/// What makes a camera: image size, lens model and its coefficients.
struct Intrinsics {
  int width_px = 0;
  int height_px = 0;
  LensModel model = LensModel::pinhole;
  /// fx, fy, cx, cy in pixels, then the distortion in OpenCV's order; unused entries are 0.
  std::array<double, kCameraParameters> parameters{};
  /// How many distortion coefficients the model was given: 0, 4, 5 or 8.
  int distortion_count = 0;
};

/// A camera that can be asked: projection with full distortion inside the lens' range of validity, its
/// inverse and its derivative.
class Camera {
 public:
  /// Throws ConfigError when the size or the focal lengths are not positive, a number is not finite, or the
  /// number of coefficients does not fit the model.
  explicit Camera(const Intrinsics& intrinsics);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }
  [[nodiscard]] int width() const { return intrinsics_.width_px; }
  [[nodiscard]] int height() const { return intrinsics_.height_px; }
  [[nodiscard]] double fx() const { return intrinsics_.parameters[kFx]; }
  [[nodiscard]] double fy() const { return intrinsics_.parameters[kFy]; }

  /// The same camera for loops over many points.
  [[nodiscard]] const LensNumbers& numbers() const { return numbers_; }

  /// Radius in normalised coordinates (tan of the angle off the axis) up to which the distortion is
  /// monotonic; infinity where it always is. Beyond it strong distortion folds the world back into the
  /// image, so nothing beyond it projects.
  [[nodiscard]] double validRadius() const { return valid_radius_; }

  /// Pixel that sees p_camera (metres); nullopt when the point is behind the camera, beyond the valid
  /// radius, outside the image [-0.5, width - 0.5) x [-0.5, height - 0.5), or not finite.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera) const;

  /// The same without asking whether the pixel lies inside the image.
  [[nodiscard]] std::optional<Eigen::Vector2d> projectUnbounded(const Eigen::Vector3d& p_camera) const;

  /// The ray (x, y, 1) in the camera frame that the pixel looks along: the inverse of the projection by
  /// Newton's method. nullopt when no ray inside the valid radius maps to the pixel.
  [[nodiscard]] std::optional<Eigen::Vector3d> rayFromPixel(const Eigen::Vector2d& pixel) const;

  /// d pixel / d p_camera, px per metre. Precondition: project(p_camera) succeeds.
  [[nodiscard]] Eigen::Matrix<double, 2, 3> jacobian(const Eigen::Vector3d& p_camera) const;

 private:
  Intrinsics intrinsics_;
  double valid_radius_ = 0.0;
  LensNumbers numbers_;
};

/// d distorted / d undistorted normalised coordinates.
[[nodiscard]] Eigen::Matrix2d distortionJacobian(LensModel model, std::span<const double, 8> d,
                                                 const Eigen::Vector2d& n);

/// See Camera::validRadius.
[[nodiscard]] double monotonicRadius(LensModel model, std::span<const double, 8> d);

}  // namespace thermovox
