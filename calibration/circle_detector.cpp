#include "calibration/circle_detector.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <utility>

#include "calibration/circle_middles.hpp"
#include "calibration/circle_refinement.hpp"
#include "calibration/grid_search.hpp"
#include "calibration/local_normalisation.hpp"

namespace thermovox {
namespace {

constexpr double kUnrefined = 0.25;   // px, one sigma of a middle by the search alone
constexpr double kMostRefined = 0.7;  // of a board's circles
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

/// From where the search has it; where it is not there, from where the whole board would have it.
std::optional<BoardCorner> refined(const BoardImage& image, const SeenCircles& seen, std::size_t i,
                                   const cv::Point2f& on_board) {
  const Eigen::Vector2d middle(on_board.x, on_board.y);
  CircleGuess guess{.pixel_from_board = seen.pixel_from_board,
                    .middle = middle,
                    .radius = seen.radius,
                    .pixel = {seen.middles[i].x, seen.middles[i].y}};
  if (const auto corner = refineCircle(image, guess)) return corner;
  guess.pixel = (seen.pixel_from_board * middle.homogeneous()).hnormalized();
  return refineCircle(image, guess);
}

std::optional<std::vector<BoardCorner>> cornersOf(const BoardImage& image, SeenCircles seen,
                                                  const Pixels& board) {
  std::vector<BoardCorner> corners;
  std::size_t count = 0;
  for (std::size_t i = 0; i < board.size(); ++i) {
    cv::Point2f& pixel = seen.middles[i];
    const std::optional<BoardCorner> corner = refined(image, seen, i, board[i]);
    if (corner) ++count;
    corners.push_back(corner.value_or(
        BoardCorner{{pixel.x, pixel.y}, kUnrefined * kUnrefined * Eigen::Matrix2d::Identity(), 0.0}));
    pixel = {static_cast<float>(corners[i].pixel.x()), static_cast<float>(corners[i].pixel.y())};
  }
  const bool enough = static_cast<double>(count) >= kMostRefined * static_cast<double>(corners.size());
  if (!enough || !isBoard(seen.middles, board)) return std::nullopt;
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
      if (auto corners = cornersOf(image, circleMiddles(values, *ellipses, board), board)) return corners;
    }
  }
  return std::nullopt;
}

}  // namespace thermovox
