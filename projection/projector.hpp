#pragma once

#include <array>
#include <limits>

#include "projection/camera_model.hpp"
#include "projection/cpu_level.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// What takes a point from camera coordinates to its pixel, as bare numbers for loops over many points.
struct LensNumbers {
  LensModel model = LensModel::pinhole;
  std::array<double, kCameraParameters> parameters{};
  double valid_radius_squared = std::numeric_limits<double>::infinity();  ///< see Camera::validRadius
  double width_px = 0.0;
  double height_px = 0.0;
};

/// A pixel and whether there is one: `valid` where the lens maps the point, `inside` where also the image
/// covers it. Where not valid the numbers mean nothing.
struct MaybePixel {
  double u, v;
  bool valid, inside;
};

/// Projects a point in camera coordinates (metres). Without control flow, so that loops over it vectorise;
/// written so that NaN is rejected too.
template <LensModel kModel>
THERMOVOX_INLINE_LOOP MaybePixel pixelOf(const LensNumbers& lens, double x, double y, double z) {
  constexpr double kMinDepth = 1e-6;  // metres
  constexpr double kMaxDepth = std::numeric_limits<double>::max();
  const Coordinates2<double> pixel = pixelFromCameraBy<kModel>(lens.parameters.data(), x, y, z);
  const bool in_lens = x * x + y * y < lens.valid_radius_squared * z * z;
  const bool valid = (z > kMinDepth) & (z <= kMaxDepth) & in_lens;
  const bool inside = (pixel.x >= -0.5) & (pixel.y >= -0.5) & (pixel.x < lens.width_px - 0.5) &
                      (pixel.y < lens.height_px - 0.5);
  return {pixel.x, pixel.y, valid, static_cast<bool>(valid & inside)};
}

/// A rigid transform as bare numbers: p_a = R p_b + t, R row by row.
struct RigidNumbers {
  std::array<double, 9> R{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> t{};

  RigidNumbers() = default;
  explicit RigidNumbers(const Pose& T_a_b)
      : t{T_a_b.translation.x(), T_a_b.translation.y(), T_a_b.translation.z()} {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data()) = T_a_b.matrix();
  }
};

struct Coordinates3 {
  double x, y, z;
};

THERMOVOX_INLINE_LOOP Coordinates3 transformed(const RigidNumbers& T_a_b, double x, double y, double z) {
  const std::array<double, 9>& R = T_a_b.R;
  return {R[0] * x + R[1] * y + R[2] * z + T_a_b.t[0], R[3] * x + R[4] * y + R[5] * z + T_a_b.t[1],
          R[6] * x + R[7] * y + R[8] * z + T_a_b.t[2]};
}

/// A camera at its place: world to pixel.
struct Projector {
  LensNumbers lens;
  RigidNumbers T_camera_world;
};

/// For the propagation of errors, in single precision: it gives the square of an error.
struct ErrorProjector {
  std::array<float, kCameraParameters> parameters{};
  std::array<float, 9> R_camera_world{};

  explicit ErrorProjector(const Projector& projector) {
    for (std::size_t i = 0; i < parameters.size(); ++i)
      parameters[i] = static_cast<float>(projector.lens.parameters[i]);
    for (std::size_t i = 0; i < R_camera_world.size(); ++i)
      R_camera_world[i] = static_cast<float>(projector.T_camera_world.R[i]);
  }
};

/// Mean of the two variances (px^2) of S_uv = J Sigma J^T for the covariance (world; xx xy xz yy yz zz) of a
/// point that lies at (x, y) = (X / Z, Y / Z) and 1 / Z in the camera.
template <LensModel kModel>
THERMOVOX_INLINE_LOOP float pixelVariance(const ErrorProjector& projector, float x, float y,
                                          float inverse_depth, const std::array<float, 6>& covariance) {
  const auto& k = projector.parameters;
  const auto& R = projector.R_camera_world;
  const Symmetric2<float> lens = distortionJacobianBy<kModel>(k.data() + kDistortion, x, y);
  // Depth times d(x, y) / d p_world: the rows of R_camera_world, less what the depth takes along.
  const float ax = R[0] - x * R[6], ay = R[1] - x * R[7], az = R[2] - x * R[8];
  const float bx = R[3] - y * R[6], by = R[4] - y * R[7], bz = R[5] - y * R[8];
  const auto& c = covariance;
  const auto alongAxis = [&](float da, float db) {
    const float jx = da * ax + db * bx, jy = da * ay + db * by, jz = da * az + db * bz;
    return jx * (c[0] * jx + 2.0F * (c[1] * jy + c[2] * jz)) + jy * (c[3] * jy + 2.0F * (c[4] * jz)) +
           c[5] * (jz * jz);
  };
  const float focal_u = k[kFx] * inverse_depth;
  const float focal_v = k[kFy] * inverse_depth;
  return 0.5F *
         (focal_u * focal_u * alongAxis(lens.xx, lens.xy) + focal_v * focal_v * alongAxis(lens.xy, lens.yy));
}

}  // namespace thermovox
