#include "calibration/circle_middles.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace thermovox {
namespace {

constexpr double kGap = 1.0;  // from a circle's middle along a row or across: between its neighbours
constexpr double kLargestRadius = 0.7;   // circles of 1 / sqrt(2) touch
constexpr double kStep = 0.02;           // of the radii that are tried
constexpr double kLeastContrast = 1e-6;  // of the image's values: rounding, not circles
constexpr int kDirections = 16;          // multiples of a quarter turn among them
constexpr int kRounds = 2;               // the homography is that of the middles, which it corrects

std::optional<Eigen::Matrix3d> homographyOf(const Pixels& board, const Pixels& pixels) {
  const cv::Mat found = cv::findHomography(board, pixels);
  if (found.empty()) return std::nullopt;
  Eigen::Matrix3d homography;
  cv::cv2eigen(found, homography);
  return homography;
}

/// The image's mean at a distance from all middles, in so many directions.
double meanAround(const cv::Mat& image, const Eigen::Matrix3d& H, const Pixels& board, double distance,
                  int directions) {
  double sum = 0.0;
  for (const cv::Point2f& middle : board) {
    for (int i = 0; i < directions; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / directions;
      const Eigen::Vector2d pixel = (H * Eigen::Vector3d(middle.x + distance * std::cos(angle),
                                                         middle.y + distance * std::sin(angle), 1.0))
                                        .hnormalized();
      cv::Mat value;
      cv::getRectSubPix(image, {1, 1}, {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())}, value);
      sum += value.at<float>(0, 0);
    }
  }
  return sum / static_cast<double>(board.size() * static_cast<std::size_t>(directions));
}

/// On the board; 0 where there is no circle.
double radiusOf(const cv::Mat& image, const Eigen::Matrix3d& H, const Pixels& board) {
  const double inside = meanAround(image, H, board, 0.0, 1);
  const double outside = meanAround(image, H, board, kGap, 4);
  if (!(std::abs(inside - outside) > kLeastContrast * std::abs(outside))) return 0.0;
  double before = 1.0;  // as a share of the way from outside to inside
  for (double radius = kStep; radius <= kLargestRadius; radius += kStep) {
    const double share = (meanAround(image, H, board, radius, kDirections) - outside) / (inside - outside);
    if (share < 0.5) return radius - kStep * (0.5 - share) / (before - share);
    before = share;
  }
  return 0.0;
}

/// From the middle of the circle to that of its ellipse, px.
Eigen::Vector2d eccentricity(const Eigen::Matrix3d& H, const cv::Point2f& middle, double radius) {
  const Eigen::Vector3d q = H * Eigen::Vector3d(middle.x, middle.y, 1.0);
  const Eigen::Vector3d ellipse =
      radius * radius * (H.col(0) * H(2, 0) + H.col(1) * H(2, 1)) - q * q.z();  // last column of D
  return ellipse.hnormalized() - q.hnormalized();
}

}  // namespace

SeenCircles circleMiddles(const cv::Mat& image, const Pixels& ellipses, const Pixels& board) {
  SeenCircles seen{.middles = ellipses};
  for (int round = 0; round < kRounds; ++round) {
    const std::optional<Eigen::Matrix3d> homography = homographyOf(board, seen.middles);
    if (!homography) return {.middles = ellipses};
    seen.pixel_from_board = *homography;
    seen.radius = radiusOf(image, *homography, board);
    for (std::size_t i = 0; i < ellipses.size(); ++i) {
      const Eigen::Vector2d off = eccentricity(*homography, board[i], seen.radius);
      seen.middles[i] = ellipses[i] - cv::Point2f(static_cast<float>(off.x()), static_cast<float>(off.y()));
    }
  }
  return seen;
}

}  // namespace thermovox
