#include "io/calibration_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "io/picture_canvas.hpp"

namespace thermovox {
namespace {

constexpr int kWidest = 480;         // px of a picture; larger parts are reduced
constexpr int kExact = 320;          // px up to which no pixel is lost to a JPEG
constexpr double kAround = 0.3;      // of the marks' extent, on either side
constexpr double kFewest = 32.0;     // px of a picture's height
constexpr double kMostlyAll = 0.75;  // of the image: then all of it is shown

/// The window in whole pixels, in the proportions of the image.
cv::Rect windowOf(const GreyImage& image, std::span<const Eigen::Vector2d> marks) {
  const cv::Rect all(0, 0, image.width_px, image.height_px);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& mark : marks) {
    if (mark.allFinite()) box.extend(mark);
  }
  if (box.isEmpty()) return all;
  const Eigen::Vector2d size(image.width_px, image.height_px);
  const double share = (1.0 + 2.0 * kAround) * box.sizes().cwiseQuotient(size).maxCoeff();
  const double shown = std::max(share, kFewest / size.minCoeff());
  if (!(shown < kMostlyAll)) return all;
  const Eigen::Vector2d extent = (shown * size).array().ceil();
  const Eigen::Vector2d corner =
      (box.center() - 0.5 * extent).array().round().max(0.0).min((size - extent).array());
  return cv::Rect(static_cast<int>(corner.x()), static_cast<int>(corner.y()), static_cast<int>(extent.x()),
                  static_cast<int>(extent.y())) &
         all;
}

/// The span from the 1st to the 99th percentile as 0 to 255.
cv::Mat stretchedBytes(const cv::Mat& values) {
  std::vector<float> sorted(values.begin<float>(), values.end<float>());
  const auto at = [&](double share) {
    const auto place =
        sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), place, sorted.end());
    return static_cast<double>(*place);
  };
  const double low = at(0.01), high = std::max(at(0.99), low + 1e-6);
  cv::Mat bytes;
  values.convertTo(bytes, CV_8U, 255.0 / (high - low), -255.0 * low / (high - low));
  return bytes;
}

}  // namespace

CalibrationPicture calibrationPicture(const GreyImage& image, std::span<const Eigen::Vector2d> marks) {
  const cv::Mat all(image.height_px, image.width_px, CV_32F,
                    const_cast<float*>(image.values.data()));  // NOLINT: OpenCV has no const view
  const cv::Rect window = windowOf(image, marks);
  const bool exact = window.width <= kExact;
  cv::Mat shown = all(window).clone();
  if (shown.cols > kWidest) {
    const double scale = static_cast<double>(kWidest) / shown.cols;
    cv::resize(shown, shown, {}, scale, scale, cv::INTER_AREA);
  }
  cv::Mat bytes = stretchedBytes(shown);
  if (exact) cv::createCLAHE(2.0, {4, 4})->apply(bytes, bytes);
  CalibrationPicture picture;
  picture.bytes = exact ? pngOf(bytes) : jpegOf(bytes);
  picture.window.extend(Eigen::Vector2d(window.x - 0.5, window.y - 0.5));
  picture.window.extend(Eigen::Vector2d(window.x + window.width - 0.5, window.y + window.height - 0.5));
  picture.image_width_px = image.width_px;
  picture.image_height_px = image.height_px;
  return picture;
}

Rgb divergingColour(double place) {
  const Eigen::Array3d blue(33, 102, 172), white(247, 247, 247), red(178, 24, 43);
  const double t = std::isfinite(place) ? std::clamp(place, -1.0, 1.0) : 0.0;
  const Eigen::Array3d colour = white + std::abs(t) * ((t < 0.0 ? blue : red) - white);
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {byte(colour[0]), byte(colour[1]), byte(colour[2])};
}

std::string hexOf(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b);
}

}  // namespace thermovox
