#pragma once

#include <Eigen/Core>
#include <span>

#include "io/palette.hpp"
#include "io/rgb_picture.hpp"
#include "projection/pose.hpp"

namespace thermovox {

/// A small disc of a surface.
struct Splat {
  Eigen::Vector3f p_world = Eigen::Vector3f::Zero();  ///< metres
  /// Unit, either side; zero where it is not known: the disc then faces the viewer.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float radius = 0.0F;  ///< metres
  Rgb colour;
};

/// A pinhole looking at the world. Camera frame: x right, y down, z forward.
struct PictureView {
  Pose T_world_view;
  double focal_px = 1000.0;
  double center_x_px = 0.0;
  double center_y_px = 0.0;
  int width_px = 0;
  int height_px = 0;
};

/// Draws the splats, the nearest in front, lit from over the viewer's left shoulder, and darkens what lies
/// behind a step in depth (eye-dome lighting, Boucheny 2009), so that shapes read without outlines.
/// Pixels that no splat covers keep the background.
[[nodiscard]] RgbPicture drawSplats(std::span<const Splat> splats, const PictureView& view,
                                    const RgbPicture& background);

}  // namespace thermovox
