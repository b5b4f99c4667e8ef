#pragma once

// What the searches for boards have in common, on OpenCV's side: only the sources of the detectors include
// it.

#include <opencv2/core/mat.hpp>
#include <vector>

#include "calibration/board_image.hpp"

namespace thermovox {

constexpr double kUsualWidth = 160.0;  ///< px, of the images that widths in the searches are for

using Pixels = std::vector<cv::Point2f>;

/// Throws ConfigError for a grid of less than three by three, and for an image without pixels or with values
/// that are not finite.
void checkSearch(const BoardImage& image, int columns, int rows);

/// The image as grey levels, in the versions in which a grid is sought.
struct SearchVersions {
  cv::Mat plain;                    ///< stretched()
  std::vector<cv::Mat> normalised;  ///< locallyNormalised() by three widths, the usual one first
};
[[nodiscard]] SearchVersions searchVersions(const cv::Mat& image);

/// How many times an image is enlarged before a grid is sought: a small one is not found otherwise.
[[nodiscard]] int enlargement(const cv::Mat& image);
[[nodiscard]] cv::Mat enlarged(const cv::Mat& image, int factor);
/// The pixels of an enlarged image in the image itself. A pixel's centre is whole, before and after.
[[nodiscard]] Pixels reduced(Pixels pixels, int factor);

/// How many times a large image is reduced for the search, by the mean of so many pixels: there is nothing to
/// be found in it that a smaller one does not show, in a quarter of the time.
[[nodiscard]] int reduction(const cv::Mat& image);
[[nodiscard]] cv::Mat shrunk(const cv::Mat& image, int factor);
/// The pixels of a reduced image in the image itself.
[[nodiscard]] Pixels unshrunk(Pixels pixels, int factor);

/// Each pixel's distance from where the homography that fits best has its point of the board, px; empty where
/// there is none.
[[nodiscard]] std::vector<double> offPlane(const Pixels& pixels, const Pixels& board);
[[nodiscard]] double rms(const std::vector<double>& values);

/// Whether the pixels are those of a plane's points, as far as a lens leaves it one.
[[nodiscard]] bool isFlat(const Pixels& pixels, const Pixels& board);

}  // namespace thermovox
