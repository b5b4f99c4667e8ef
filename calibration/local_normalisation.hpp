#pragma once

// The adapter between board images and OpenCV: only the sources of the detector include it.

#include <opencv2/core/mat.hpp>

#include "calibration/board_image.hpp"

namespace thermovox {

/// The image as OpenCV has it, 32-bit float; it refers to the image's own values.
[[nodiscard]] cv::Mat asMat(const BoardImage& image);

/// Brightness against what is around, in units of how much that varies:
///
///   127 + 55 (G_0.6 - G_s) / sqrt(G_1.5s (G_0.6 - G_s)^2)
///
/// with G_s a Gaussian of s px; 8 bits. A lamp's hot spot, a gradient or a warm reflection on a board go, its
/// squares stay, where s is about 0.4 of one.
[[nodiscard]] cv::Mat locallyNormalised(const cv::Mat& image, double sigma_px);

/// The span from the 2nd to the 98th percentile as 0 to 255.
[[nodiscard]] cv::Mat stretched(const cv::Mat& image);

}  // namespace thermovox
