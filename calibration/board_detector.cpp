#include "calibration/board_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "calibration/local_normalisation.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr double kUsualWidth = 160.0;                    // px, of the images that the widths are for
constexpr std::array<double, 3> kWidths{4.0, 2.5, 6.0};  // px there: some 0.4 of a square
constexpr double kMostOff = 0.7;                         // px rms from a plane's grid
constexpr double kMostBent = 0.015;                      // the same, of the board's diagonal: a lens bends it
constexpr double kUnrefined = 0.25;                      // px, one sigma of a corner by the search alone
constexpr double kMostRefined = 0.7;                     // of a board's corners
constexpr double kAlternating = 0.9;                     // of the neighbouring squares

using Pixels = std::vector<cv::Point2f>;

/// How many times an image is enlarged before a grid is sought: small squares are not found otherwise.
int enlargement(const cv::Mat& image) {
  return std::clamp(static_cast<int>(std::lround(4.0 * kUsualWidth / image.cols)), 1, 4);
}

cv::Mat enlarged(const cv::Mat& image, int factor) {
  if (factor == 1) return image;
  cv::Mat large;
  cv::resize(image, large, {}, factor, factor, cv::INTER_CUBIC);
  return large;
}

/// A pixel's centre is whole, before and after.
Pixels reduced(Pixels pixels, int factor) {
  for (cv::Point2f& pixel : pixels) {
    pixel = (pixel + cv::Point2f(0.5F, 0.5F)) / static_cast<float>(factor) - cv::Point2f(0.5F, 0.5F);
  }
  return pixels;
}

/// Whether the pixels are the grid of a plane, as far as a lens leaves it one.
bool isFlat(const Pixels& pixels, const ChessboardGrid& grid) {
  Pixels board;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      board.emplace_back(static_cast<float>(column), static_cast<float>(row));
    }
  }
  const cv::Mat homography = cv::findHomography(board, pixels);
  if (homography.empty()) return false;
  Pixels expected;
  cv::perspectiveTransform(board, expected, homography);
  double squares = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const cv::Point2f off = pixels[i] - expected[i];
    squares += static_cast<double>(off.dot(off));
  }
  const cv::Rect2f box = cv::boundingRect(pixels);
  const double diagonal = std::hypot(static_cast<double>(box.width), static_cast<double>(box.height));
  return std::sqrt(squares / static_cast<double>(pixels.size())) < std::max(kMostOff, kMostBent * diagonal);
}

/// Whether neighbouring squares differ as those of a chessboard, in either polarity.
bool alternates(const cv::Mat& grey, const Pixels& pixels, const ChessboardGrid& grid) {
  const auto corner = [&](int row, int column) {
    return pixels[static_cast<std::size_t>(row * grid.columns + column)];
  };
  cv::Mat squares(grid.rows - 1, grid.columns - 1, CV_64F);
  for (int row = 0; row < squares.rows; ++row) {
    for (int column = 0; column < squares.cols; ++column) {
      const cv::Point2f middle = 0.25F * (corner(row, column) + corner(row + 1, column) +
                                          corner(row, column + 1) + corner(row + 1, column + 1));
      cv::Mat pixel;
      cv::getRectSubPix(grey, {1, 1}, middle, pixel);
      squares.at<double>(row, column) =
          (row + column) % 2 == 0 ? pixel.at<std::uint8_t>(0) : -pixel.at<std::uint8_t>(0);
    }
  }
  int pairs = 0, rising = 0;  // even squares against odd ones: brighter in all pairs, or in none
  for (int row = 0; row < squares.rows; ++row) {
    for (int column = 0; column < squares.cols; ++column) {
      for (const auto& [down, right] : {std::pair(0, 1), {1, 0}}) {
        if (row + down >= squares.rows || column + right >= squares.cols) continue;
        ++pairs;
        if (squares.at<double>(row, column) + squares.at<double>(row + down, column + right) > 0.0) ++rising;
      }
    }
  }
  return std::max(rising, pairs - rising) >= kAlternating * pairs;
}

std::optional<Pixels> gridIn(const cv::Mat& grey, const ChessboardGrid& grid) {
  const int factor = enlargement(grey);
  Pixels pixels;
  if (!cv::findChessboardCornersSB(enlarged(grey, factor), {grid.columns, grid.rows}, pixels,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE)) {
    return std::nullopt;
  }
  return reduced(std::move(pixels), factor);
}

std::optional<Pixels> gridOfOldSearch(const cv::Mat& grey, const ChessboardGrid& grid) {
  const int factor = std::min(3, enlargement(grey));
  for (const bool inverted : {false, true}) {
    Pixels pixels;
    const cv::Mat seen = enlarged(inverted ? cv::Mat(255 - grey) : grey, factor);
    if (cv::findChessboardCorners(seen, {grid.columns, grid.rows}, pixels)) {
      return reduced(std::move(pixels), factor);
    }
  }
  return std::nullopt;
}

std::optional<std::vector<BoardCorner>> cornersOf(const BoardImage& image, const Pixels& pixels,
                                                  const ChessboardGrid& grid) {
  const auto at = [&](int row, int column) {
    const cv::Point2f& pixel = pixels[static_cast<std::size_t>(row * grid.columns + column)];
    return Eigen::Vector2d(pixel.x, pixel.y);
  };
  std::vector<BoardCorner> corners;
  std::size_t refined = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const int left = std::min(column, grid.columns - 2), above = std::min(row, grid.rows - 2);
      const CornerGuess guess{at(row, column), at(row, left + 1) - at(row, left),
                              at(above + 1, column) - at(above, column)};
      const std::optional<BoardCorner> corner = refineCorner(image, guess);
      if (corner) ++refined;
      corners.push_back(corner.value_or(
          BoardCorner{guess.pixel, kUnrefined * kUnrefined * Eigen::Matrix2d::Identity(), 0.0}));
    }
  }
  if (static_cast<double>(refined) < kMostRefined * static_cast<double>(corners.size())) return std::nullopt;
  return corners;
}

void check(const BoardImage& image, const ChessboardGrid& grid) {
  if (grid.columns < 3 || grid.rows < 3) {
    throw ConfigError("board.inner_corners: found " + std::to_string(grid.columns) + " x " +
                      std::to_string(grid.rows) + ", expected 3 x 3 or more");
  }
  const auto pixels = static_cast<std::size_t>(std::max(image.width, 0)) *
                      static_cast<std::size_t>(std::max(image.height, 0));
  if (pixels == 0 || image.values.size() != pixels ||
      !std::all_of(image.values.begin(), image.values.end(),
                   [](float value) { return std::isfinite(value); }))
    throw ConfigError("the image of a board: expected pixels with finite values, as many as its size says");
}

}  // namespace

std::optional<std::vector<BoardCorner>> findChessboard(const BoardImage& image, const ChessboardGrid& grid) {
  check(image, grid);
  const cv::Mat values = asMat(image);
  const double scale = std::max(1.0, values.cols / kUsualWidth);
  const cv::Mat usual = locallyNormalised(values, scale * kWidths.front());
  std::vector<cv::Mat> versions{usual};
  for (const double width : {kWidths[1], kWidths[2]})
    versions.push_back(locallyNormalised(values, scale * width));
  versions.push_back(stretched(values));
  const auto isBoard = [&](const std::optional<Pixels>& pixels) {
    return pixels && isFlat(*pixels, grid) && alternates(usual, *pixels, grid);
  };
  for (const auto search : {&gridIn, &gridOfOldSearch}) {
    for (const cv::Mat& version : versions) {
      const std::optional<Pixels> pixels = search(version, grid);
      if (isBoard(pixels)) return cornersOf(image, *pixels, grid);
    }
  }
  return std::nullopt;
}

}  // namespace thermovox
