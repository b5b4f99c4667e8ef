#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "calibration/board_image.hpp"

namespace thermovox::test {

/// A heated chessboard as a camera shows it; lengths on the board in squares, its first inner corner at 0, 0.
struct RenderedBoard {
  int columns = 9;  ///< inner corners
  int rows = 6;
  Eigen::Matrix3d pixel_from_board = Eigen::Matrix3d::Identity();  ///< a homography
  double warm = 8.0;     ///< C, of the warm squares over the cold ones
  double margin = 0.6;   ///< of plain board beyond the outer squares
  double blur_px = 0.6;  ///< of the optics, one sigma
  double noise = 0.05;   ///< C, one sigma
  unsigned seed = 1;
  int width = 160;
  int height = 120;

  [[nodiscard]] Eigen::Vector2d cornerAt(int column, int row) const {
    return (pixel_from_board * Eigen::Vector3d(column, row, 1.0)).hnormalized();
  }
  /// Degrees over the board's plain margin; the surroundings are 2 C colder.
  [[nodiscard]] double celsiusAt(const Eigen::Vector2d& board) const {
    const double x = board.x() + 1.0, y = board.y() + 1.0;  // from the outer squares' corner
    if (x < -margin || y < -margin || x > columns + 1 + margin || y > rows + 1 + margin) return -2.0;
    if (x < 0.0 || y < 0.0 || x > columns + 1 || y > rows + 1) return 0.0;
    return (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) % 2 == 0 ? warm : 0.0;
  }
};

/// Six samples a pixel's edge, the optics' blur over these, their mean.
template <typename Board>
[[nodiscard]] BoardImage imageOf(const Board& board) {
  constexpr int kFine = 6;
  const Eigen::Matrix3d board_from_pixel = board.pixel_from_board.inverse();
  cv::Mat fine(board.height * kFine, board.width * kFine, CV_64F), seen;
  for (int v = 0; v < fine.rows; ++v) {
    for (int u = 0; u < fine.cols; ++u) {
      const Eigen::Vector3d pixel((u + 0.5) / kFine - 0.5, (v + 0.5) / kFine - 0.5, 1.0);
      fine.at<double>(v, u) = board.celsiusAt((board_from_pixel * pixel).hnormalized());
    }
  }
  cv::GaussianBlur(fine, fine, {}, kFine * board.blur_px);
  cv::resize(fine, seen, {board.width, board.height}, 0, 0, cv::INTER_AREA);
  std::mt19937_64 random(board.seed);
  std::normal_distribution<double> noise(0.0, board.noise);
  BoardImage image{board.width, board.height, {}};
  for (int v = 0; v < seen.rows; ++v) {
    for (int u = 0; u < seen.cols; ++u) {
      image.values.push_back(static_cast<float>(25.0 + seen.at<double>(v, u) + noise(random)));
    }
  }
  return image;
}

/// Squares of about `square_px`, turned in the image and tilted.
[[nodiscard]] inline Eigen::Matrix3d homographyOf(double square_px, double turn_deg,
                                                  const Eigen::Vector2d& first,
                                                  const Eigen::Vector2d& tilt = {0.0, 0.0}) {
  const double turn = turn_deg * M_PI / 180.0;
  Eigen::Matrix3d H;
  H << square_px * std::cos(turn), -square_px * std::sin(turn), first.x(),  //
      square_px * std::sin(turn), square_px * std::cos(turn), first.y(),    //
      tilt.x(), tilt.y(), 1.0;
  return H;
}

}  // namespace thermovox::test
