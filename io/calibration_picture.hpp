#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "io/palette.hpp"

namespace thermovox {

/// Brightness, counts or temperatures, row by row: only differences matter.
struct GreyImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> values;  ///< finite
};

/// A part of an image as bytes of a PNG (small images, pixel by pixel) or a JPEG (large ones, reduced).
struct CalibrationPicture {
  std::string bytes;
  /// What it shows, in pixels of the image: [left, right) x [top, bottom), pixel (0, 0) is from -0.5 to 0.5.
  Eigen::AlignedBox2d window;
  int image_width_px = 0, image_height_px = 0;
};

/// The part of an image about the marks (px), with some of what is around; all of it where there are none or
/// they fill it. Its contrast is stretched by what is in it, from place to place.
[[nodiscard]] CalibrationPicture calibrationPicture(const GreyImage& image,
                                                    std::span<const Eigen::Vector2d> marks);

/// -1 blue, 0 white, 1 red; beyond, the end's.
[[nodiscard]] Rgb divergingColour(double place);

/// "#rrggbb".
[[nodiscard]] std::string hexOf(const Rgb& colour);

}  // namespace thermovox
