#pragma once

#include <algorithm>

#include "tests/calibration/rendered_board.hpp"

namespace thermovox::test {

/// A heated asymmetric grid of circles as a camera shows it; lengths on the board in half distances of
/// neighbours in a row, the middle of its first circle at 0, 0. imageOf() and homographyOf() are those of
/// rendered_board.hpp.
struct RenderedCircles {
  int columns = 4;
  int rows = 11;
  Eigen::Matrix3d pixel_from_board = Eigen::Matrix3d::Identity();  ///< a homography
  double radius = 0.5;                                             ///< of a circle
  double warm = 8.0;                                               ///< C, of the circles over the board
  double margin = 1.2;                                             ///< of board beyond the outer middles
  double blur_px = 0.6;                                            ///< of the optics, one sigma
  double noise = 0.05;                                             ///< C, one sigma
  unsigned seed = 1;
  int width = 160;
  int height = 120;

  [[nodiscard]] Eigen::Vector2d middleAt(int column, int row) const {
    return (pixel_from_board * Eigen::Vector3d(2 * column + row % 2, row, 1.0)).hnormalized();
  }
  /// Degrees over the board's; the surroundings are 2 C colder.
  [[nodiscard]] double celsiusAt(const Eigen::Vector2d& board) const {
    if (board.x() < -margin || board.y() < -margin || board.x() > 2 * columns - 1 + margin ||
        board.y() > rows - 1 + margin)
      return -2.0;
    const int nearest = static_cast<int>(std::lround(board.y()));
    for (int row = std::max(nearest - 1, 0); row <= std::min(nearest + 1, rows - 1); ++row) {
      const int shift = row % 2;
      const int column = std::clamp(static_cast<int>(std::lround(0.5 * (board.x() - shift))), 0, columns - 1);
      if ((board - Eigen::Vector2d(2 * column + shift, row)).norm() < radius) return warm;
    }
    return 0.0;
  }
};

/// The 4 x 11 board before a camera of 160 x 120 pixels with f = 150, so many half distances away.
[[nodiscard]] inline RenderedCircles tiltedCircles(double tilt_deg, double distance) {
  const Eigen::Matrix3d camera{{150.0, 0.0, 79.5}, {0.0, 150.0, 59.5}, {0.0, 0.0, 1.0}};
  const Eigen::Vector3d axis = Eigen::Vector3d(0.6, 0.8, 0.0);
  const Eigen::Matrix3d R_camera_board =
      (Eigen::AngleAxisd(tilt_deg * M_PI / 180.0, axis) * Eigen::AngleAxisd(1.7, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  Eigen::Matrix3d ray_from_board = R_camera_board;  // of (x, y, 1): the board is its plane z = 0
  ray_from_board.col(2) =
      Eigen::Vector3d(0.0, 0.0, distance) - R_camera_board * Eigen::Vector3d(3.5, 5.0, 0.0);
  return {.pixel_from_board = camera * ray_from_board};
}

}  // namespace thermovox::test
