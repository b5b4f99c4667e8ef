#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapping/hotspot.hpp"
#include "projection/rig.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// One thermal frame and one reading of a beam that was taken with it.
struct BeamShot {
  Laser beam;
  ThermalCamera camera;
  double range = 0.0;  ///< the beam's reading, metres
  /// Unit normal of the surface, body frame; without it the beam is taken to meet the surface at a right
  /// angle.
  std::optional<Eigen::Vector3d> normal_body;

  /// Where the beam meets the surface: T_body_laser (range, 0, 0), metres, body frame.
  [[nodiscard]] Eigen::Vector3d hitBody() const;
  /// Normal of the plane that all blobs are taken to lie in.
  [[nodiscard]] Eigen::Vector3d planeNormalBody() const;
  /// Throws ConfigError for a laser that is no beam and a normal that is no unit vector, DataError for a
  /// range that the laser does not measure.
  void validate() const;
};

/// Where a blob is taken to be.
struct BlobPlace {
  Eigen::Vector3d p_camera = Eigen::Vector3d::Zero();  ///< metres
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();    ///< metres
  Eigen::Matrix3d random = Eigen::Matrix3d::Zero();  ///< of p_body, m^2: noise of the range and the centroid
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();  ///< bias of the range, extrinsics of the laser
  double area = 0.0;                                 ///< m^2, of the plane that its pixels see
  [[nodiscard]] Eigen::Matrix3d covariance() const { return random + common; }
};

/// Pixels of a frame that touch, also by their corners, and are from some temperature on.
struct ThermalBlob {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();             ///< centroid (u, v), weighted by the excess
  Eigen::Matrix2d pixel_covariance = Eigen::Matrix2d::Zero();  ///< px^2: noise of the pixels and their size
  std::size_t pixels = 0;
  Estimate peak;                   ///< C, of its hottest pixel, with the noise of one pixel
  double bias_sigma = 0.0;         ///< of the camera, C, not in the peak's sigma
  double mean = 0.0;               ///< C
  bool reads_low = false;          ///< fewer than 3 x 3 pixels, or narrower than three
  std::optional<BlobPlace> place;  ///< none where its ray does not meet the plane, or only at a slant
};

/// Blobs from `above` (C) on, the hottest first, of equal ones in the order of their first pixels.
///
/// This is an approximation: ONE distance stands for all that the frame shows. The beam's hit spans a plane
/// across the beam (or across the normal that is known), and a blob lies where the ray of its centroid meets
/// it: of the ray o + s d, the plane's point h and normal n,
///   p = o + s d,  s = n (h - o) / (n d).
/// What lies before or behind the plane is put onto it, and no covariance says so. With the beam along the
/// optical axis it is the pinhole's X = (u - cx) Z / fx, Y = (v - cy) Z / fy at the beam's depth Z.
/// First order, with R' = Exp(w) R and t' = t + v of the laser's mounting, b its direction:
///   n d ds = n b d_range + n v + ((h - t) x n) w - (n x (p - h)) w - s n d(d),
/// the fourth term only where n is the beam's direction, which turns with it. The camera's own place and lens
/// are taken as exact.
/// Throws DataError when the image has another size than the camera, and what BeamShot::validate throws.
[[nodiscard]] std::vector<ThermalBlob> locateBlobs(const ThermalImage& image, double above,
                                                   const BeamShot& shot);

}  // namespace thermovox
