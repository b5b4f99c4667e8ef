#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "projection/calibration_board.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox::simulate {

/// What a ray meets of a chessboard and its surroundings.
enum class BoardPart { surroundings, margin, dark_square, light_square };

/// What a place of the board looks like (C, or brightness), by its part and its place on the plane [m].
using BoardPaint = std::function<float(BoardPart part, const Eigen::Vector2f& place)>;

/// Renders a board through a camera's exact lens. The image is divided into cells, one or several a pixel and
/// axis. A cell's corners are looked up on the board through rays of the lens; a cell within one part of it
/// has the paint of its middle, any other the mean of 64 samples. Cells are blurred by what the optics add to
/// the pixel's own blur, and averaged to pixels.
class BoardRenderer {
 public:
  /// blur_px: optics and pixel together, one sigma of a Gaussian; no less than the pixel's own 0.29.
  /// `threads` look up the rays.
  BoardRenderer(const Camera& camera, int cells_per_pixel, double blur_px, unsigned threads);

  /// Row by row, without noise. The top left square is a dark one.
  [[nodiscard]] std::vector<float> render(const CalibrationBoard& board, const Pose& T_camera_board,
                                          const BoardPaint& paint) const;

 private:
  using Places = std::vector<Eigen::Vector2f>;
  /// Where the rays of one row of the cells' corners meet the board's plane; NaN where they do not.
  [[nodiscard]] Places placesOf(int row, const Eigen::Matrix3f& plane_from_ray) const;
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::vector<float> blurred(const std::vector<float>& cells) const;
  [[nodiscard]] std::vector<float> pixelsOf(const std::vector<float>& cells) const;

  int cells_per_pixel_;
  int columns_;  ///< of cells
  int rows_;
  std::vector<float> kernel_;          ///< of the optics, in cells, its middle at size / 2
  std::vector<Eigen::Vector2f> rays_;  ///< (x, y, 1) through the cells' corners; NaN where the lens has none
};

}  // namespace thermovox::simulate
