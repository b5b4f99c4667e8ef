#include "calibration/board_detector.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calibration/grid_search.hpp"
#include "calibration/local_normalisation.hpp"

namespace thermovox {
namespace {

constexpr double kUnrefined = 0.25;   // px, one sigma of a corner by the search alone
constexpr double kMostRefined = 0.7;  // of a board's corners
constexpr double kAlternating = 0.9;  // of the neighbouring squares

/// The corners on the board, in squares.
Pixels cornersOnBoard(const ChessboardGrid& grid) {
  Pixels board;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      board.emplace_back(static_cast<float>(column), static_cast<float>(row));
    }
  }
  return board;
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

/// Columns to the right and rows down as one looks at the board: what is found may be its mirror image.
Pixels unmirrored(Pixels pixels, const ChessboardGrid& grid) {
  const auto columns = static_cast<std::size_t>(grid.columns);
  const cv::Point2f along = pixels[columns - 1] - pixels[0],
                    down = pixels[pixels.size() - columns] - pixels[0];
  if (along.cross(down) > 0.0F) return pixels;
  for (auto row = pixels.begin(); row != pixels.end(); row += grid.columns)
    std::reverse(row, row + grid.columns);
  return pixels;
}

/// The grid in an image, by the first of all searches and versions of it that finds one. The old search takes
/// minutes for a large image full of normalised noise, so that it gets small ones only.
std::optional<Pixels> searched(const cv::Mat& image, const ChessboardGrid& grid) {
  constexpr int kOldSearchWidth = 320;  // px
  const SearchVersions all = searchVersions(image);
  std::vector<cv::Mat> versions = all.normalised;
  versions.push_back(all.plain);
  const Pixels board = cornersOnBoard(grid);
  const auto found = [&](const auto& search) -> std::optional<Pixels> {
    for (const cv::Mat& version : versions) {
      std::optional<Pixels> pixels = search(version, grid);
      if (pixels && isFlat(*pixels, board) && alternates(versions.front(), *pixels, grid))
        return unmirrored(*std::move(pixels), grid);
    }
    return std::nullopt;
  };
  std::optional<Pixels> pixels = found(gridIn);
  if (!pixels && image.cols <= kOldSearchWidth) pixels = found(gridOfOldSearch);
  return pixels;
}

}  // namespace

std::optional<std::vector<BoardCorner>> findChessboard(const BoardImage& image, const ChessboardGrid& grid) {
  checkSearch(image, grid.columns, grid.rows);
  const cv::Mat whole = asMat(image);
  const int shrink = reduction(whole);
  std::optional<Pixels> pixels;
  if (shrink > 1) {
    pixels = searched(shrunk(whole, shrink), grid);
    if (pixels) pixels = unshrunk(*std::move(pixels), shrink);
  }
  if (!pixels) pixels = searched(whole, grid);
  if (!pixels) return std::nullopt;
  return cornersOf(image, *pixels, grid);
}

}  // namespace thermovox
