#include "calibration/circle_detector.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <utility>

#include "calibration/circle_middles.hpp"
#include "calibration/grid_search.hpp"
#include "calibration/local_normalisation.hpp"

namespace thermovox {
namespace {

/// One sigma of a middle, px an axis. Rendered boards have 0.01 px at 8 C of contrast and 0.03 at 1.5 C,
/// under up to 50 degrees (noise 50 mK, blur 0.6 px, 6 px and more between rows).
constexpr double kSigma = 0.03;
constexpr double kOutlier = 4.0;   // times the rms distance from the plane's grid: circles that ran together
constexpr double kLeastOff = 0.3;  // px; what is less is noise

/// The middles on the board, in half distances of neighbours in a row.
Pixels circlesOnBoard(const CircleGrid& grid) {
  Pixels board;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      board.emplace_back(static_cast<float>(2 * column + row % 2), static_cast<float>(row));
    }
  }
  return board;
}

/// Of dark blobs: OpenCV's, but for circles as large as a grid in the image can have them.
cv::Ptr<cv::FeatureDetector> blobDetector(const cv::Mat& grey, const CircleGrid& grid) {
  cv::SimpleBlobDetector::Params parameters;
  parameters.minArea = 20.0F;
  parameters.maxArea = static_cast<float>(grey.total()) / static_cast<float>(grid.columns * grid.rows);
  parameters.minThreshold = 20.0F;
  parameters.maxThreshold = 235.0F;
  parameters.minDistBetweenBlobs = 5.0F;
  return cv::SimpleBlobDetector::create(parameters);
}

/// The grid of dark circles.
std::optional<Pixels> gridIn(const cv::Mat& grey, const CircleGrid& grid) {
  const int factor = enlargement(grey);
  const cv::Mat large = enlarged(grey, factor);
  Pixels pixels;
  if (!cv::findCirclesGrid(large, {grid.columns, grid.rows}, pixels,
                           cv::CALIB_CB_ASYMMETRIC_GRID | cv::CALIB_CB_CLUSTERING,
                           blobDetector(large, grid))) {
    return std::nullopt;
  }
  return reduced(std::move(pixels), factor);
}

/// Whether the pixels are the grid, all of them.
bool isBoard(const Pixels& pixels, const Pixels& board) {
  const std::vector<double> off = offPlane(pixels, board);
  return isFlat(pixels, board) &&
         *std::max_element(off.begin(), off.end()) < std::max(kLeastOff, kOutlier * rms(off));
}

std::vector<BoardCorner> cornersOf(const Pixels& middles) {
  std::vector<BoardCorner> corners;
  for (const cv::Point2f& pixel : middles) {
    corners.push_back({{pixel.x, pixel.y}, kSigma * kSigma * Eigen::Matrix2d::Identity(), 0.0});
  }
  return corners;
}

}  // namespace

std::optional<std::vector<BoardCorner>> findCircles(const BoardImage& image, const CircleGrid& grid) {
  checkSearch(image, grid.columns, grid.rows);
  const cv::Mat values = asMat(image);
  const SearchVersions all = searchVersions(values);
  std::vector<cv::Mat> versions{all.plain};
  versions.insert(versions.end(), all.normalised.begin(), all.normalised.end());
  const Pixels board = circlesOnBoard(grid);
  for (const cv::Mat& version : versions) {
    for (const cv::Mat& grey : {version, cv::Mat(255 - version)}) {
      const std::optional<Pixels> ellipses = gridIn(grey, grid);
      if (!ellipses || !isFlat(*ellipses, board)) continue;
      const Pixels middles = circleMiddles(values, *ellipses, board);
      if (isBoard(middles, board)) return cornersOf(middles);
    }
  }
  return std::nullopt;
}

}  // namespace thermovox
