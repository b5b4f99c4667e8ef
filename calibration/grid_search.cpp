#include "calibration/grid_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "calibration/local_normalisation.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

constexpr std::array<double, 3> kWidths{4.0, 2.5, 6.0};  // px of the usual image: some 0.4 of a square
constexpr double kMostOff = 0.7;                         // px rms from a plane's grid
constexpr double kMostBent = 0.015;                      // the same, of the board's diagonal: a lens bends it

}  // namespace

void checkSearch(const BoardImage& image, int columns, int rows) {
  if (columns < 3 || rows < 3) {
    throw ConfigError("board.inner_corners: found " + std::to_string(columns) + " x " + std::to_string(rows) +
                      ", expected 3 x 3 or more");
  }
  const auto pixels = static_cast<std::size_t>(std::max(image.width, 0)) *
                      static_cast<std::size_t>(std::max(image.height, 0));
  if (pixels == 0 || image.values.size() != pixels ||
      !std::all_of(image.values.begin(), image.values.end(),
                   [](float value) { return std::isfinite(value); }))
    throw ConfigError("the image of a board: expected pixels with finite values, as many as its size says");
}

SearchVersions searchVersions(const cv::Mat& image) {
  const double scale = std::max(1.0, image.cols / kUsualWidth);
  SearchVersions versions{.plain = stretched(image)};
  for (const double width : kWidths) versions.normalised.push_back(locallyNormalised(image, scale * width));
  return versions;
}

int enlargement(const cv::Mat& image) {
  return std::clamp(static_cast<int>(std::lround(4.0 * kUsualWidth / image.cols)), 1, 4);
}

cv::Mat enlarged(const cv::Mat& image, int factor) {
  if (factor == 1) return image;
  cv::Mat large;
  cv::resize(image, large, {}, factor, factor, cv::INTER_CUBIC);
  return large;
}

Pixels reduced(Pixels pixels, int factor) {
  for (cv::Point2f& pixel : pixels) {
    pixel = (pixel + cv::Point2f(0.5F, 0.5F)) / static_cast<float>(factor) - cv::Point2f(0.5F, 0.5F);
  }
  return pixels;
}

int reduction(const cv::Mat& image) {
  constexpr int kSearchWidth = 960;  // px
  return std::max(1, image.cols / kSearchWidth);
}

cv::Mat shrunk(const cv::Mat& image, int factor) {
  cv::Mat small;
  const cv::Mat whole =
      image(cv::Rect(0, 0, image.cols - image.cols % factor, image.rows - image.rows % factor));
  cv::resize(whole, small, {whole.cols / factor, whole.rows / factor}, 0.0, 0.0, cv::INTER_AREA);
  return small;
}

Pixels unshrunk(Pixels pixels, int factor) {
  for (cv::Point2f& pixel : pixels) {
    pixel = (pixel + cv::Point2f(0.5F, 0.5F)) * static_cast<float>(factor) - cv::Point2f(0.5F, 0.5F);
  }
  return pixels;
}

std::vector<double> offPlane(const Pixels& pixels, const Pixels& board) {
  const cv::Mat homography = cv::findHomography(board, pixels);
  if (homography.empty()) return {};
  Pixels expected;
  cv::perspectiveTransform(board, expected, homography);
  std::vector<double> distances;
  for (std::size_t i = 0; i < pixels.size(); ++i) distances.push_back(cv::norm(pixels[i] - expected[i]));
  return distances;
}

double rms(const std::vector<double>& values) {
  const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

bool isFlat(const Pixels& pixels, const Pixels& board) {
  const std::vector<double> off = offPlane(pixels, board);
  const cv::Rect2f box = cv::boundingRect(pixels);
  const double diagonal = std::hypot(static_cast<double>(box.width), static_cast<double>(box.height));
  return !off.empty() && rms(off) < std::max(kMostOff, kMostBent * diagonal);
}

}  // namespace thermovox
