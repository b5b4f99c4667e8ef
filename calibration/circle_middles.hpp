#pragma once

// On OpenCV's side: only the sources of the detectors include it.

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "calibration/grid_search.hpp"

namespace thermovox {

/// Circles of one size on a plane, and where they are seen.
struct SeenCircles {
  Pixels middles;
  Eigen::Matrix3d pixel_from_board = Eigen::Matrix3d::Identity();  ///< a homography, of the middles
  double radius = 0.0;  ///< on the board; 0 where the image shows no circles there
};

/// Where the middles of circles on a plane are seen, given the middles of the ellipses that they are seen as.
/// The circle of radius r about p on the board, seen by the homography H = (h1 h2 h3), is the ellipse with
/// the dual conic D = r^2 (h1 h1' + h2 h2') - q q', q = H (p, 1); D's last column is its middle, q that of
/// the circle (Hartley and Zisserman, section 2.2.3). For circles of 5 px under 40 degrees they are up to 0.2
/// px apart. The radius is where the image (32-bit float), averaged about all circles, is half way from their
/// inside to the board between them.
///
/// `board` has the middles on an asymmetric grid, in half distances of neighbours in a row; lengths on the
/// board are in these. Where the image shows no circles there, the pixels stay as they are.
[[nodiscard]] SeenCircles circleMiddles(const cv::Mat& image, const Pixels& ellipses, const Pixels& board);

}  // namespace thermovox
