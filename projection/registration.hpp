#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// Two cameras that see the same scene: `from` whose pixels are asked about, and `to` where they are looked
/// for. Both must outlive the pair.
struct CameraPair {
  const Camera& from;
  const Camera& to;
  Pose T_to_from;
};

/// Pixel of `to` that shows what `from` sees at a pixel, the surface being at this depth (metres along the
/// optical axis of `from`). It may lie outside the image. nullopt where a lens has no such ray, the point is
/// behind `to`, or the depth is not positive and finite.
[[nodiscard]] std::optional<Eigen::Vector2d> pixelAcross(const CameraPair& pair, const Eigen::Vector2d& pixel,
                                                         double depth);

/// Where the pixels of an image of width x height lie in another picture, row by row, px; NaN where nowhere.
struct PixelMap {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector2d> pixels;

  /// The same for a place between the pixels: bilinear, beyond the outermost centres carried on linearly.
  /// NaN where a pixel beside it has none. Precondition: width and height are at least 2.
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& pixel) const;
};

/// Where every pixel of `from` lies in the image of `to`. `depths`: of the surface at each pixel, row by row,
/// metres along the optical axis, NaN where not known; or one number for all, a surface that faces the
/// camera.
[[nodiscard]] PixelMap registerPixels(const CameraPair& pair, std::span<const double> depths);

/// A surface at a pixel.
struct PixelDepth {
  Eigen::Vector2d pixel;
  double depth = 0.0;  ///< metres along the optical axis
};

/// Depth at every pixel of an image, row by row: that of the nearest of these points in the image (to within
/// the error of two passes of P.-E. Danielsson, "Euclidean distance mapping", 1980: a fraction of a pixel),
/// and of those in one pixel the one in front. NaN everywhere when no point is inside the image.
[[nodiscard]] std::vector<double> nearestDepths(int width_px, int height_px,
                                                std::span<const PixelDepth> points);

}  // namespace thermovox
