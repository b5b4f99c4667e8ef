#include "calibration/circle_detector.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <utility>

#include "calibration/grid_search.hpp"
#include "calibration/local_normalisation.hpp"

namespace thermovox {
namespace {

/// One sigma of a middle, px an axis. Rendered boards have 0.02 px at 8 C of contrast and 0.04 at 1.5 C
/// (noise 50 mK, 10 px between rows); the rest is for tilted circles, whose middles are not those of their
/// ellipses.
constexpr double kSigma = 0.05;

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

std::vector<BoardCorner> middlesOf(const Pixels& pixels) {
  std::vector<BoardCorner> middles;
  for (const cv::Point2f& pixel : pixels) {
    middles.push_back({{pixel.x, pixel.y}, kSigma * kSigma * Eigen::Matrix2d::Identity(), 0.0});
  }
  return middles;
}

}  // namespace

std::optional<std::vector<BoardCorner>> findCircles(const BoardImage& image, const CircleGrid& grid) {
  checkSearch(image, grid.columns, grid.rows);
  const SearchVersions all = searchVersions(asMat(image));
  std::vector<cv::Mat> versions{all.plain};
  versions.insert(versions.end(), all.normalised.begin(), all.normalised.end());
  const Pixels board = circlesOnBoard(grid);
  for (const cv::Mat& version : versions) {
    for (const cv::Mat& grey : {version, cv::Mat(255 - version)}) {
      const std::optional<Pixels> pixels = gridIn(grey, grid);
      if (pixels && isFlat(*pixels, board)) return middlesOf(*pixels);
    }
  }
  return std::nullopt;
}

}  // namespace thermovox
