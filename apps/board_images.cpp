#include "apps/board_images.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/board_detector.hpp"
#include "calibration/circle_detector.hpp"
#include "io/thermal_recording.hpp"
#include "io/visible_picture.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Pixels without a value would stop every search: they get the mean of the others.
void fillUnknown(std::vector<float>& values, const std::filesystem::path& file) {
  double sum = 0.0;
  std::size_t known = 0;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    sum += static_cast<double>(value);
    ++known;
  }
  if (known == 0) throw DataError(file.string() + ": no pixel has a value, expected the image of a board");
  const auto mean = static_cast<float>(sum / static_cast<double>(known));
  std::replace_if(
      values.begin(), values.end(), [](float value) { return !std::isfinite(value); }, mean);
}

}  // namespace

BoardImage readThermalBoard(const std::filesystem::path& file, const std::string& named_by,
                            const Camera& camera) {
  const RawThermalImage raw =
      openThermalRecording(file, {.named_by = named_by, .visible = VisibleInFrame::leave_out})->read(0);
  if (raw.width != camera.width() || raw.height != camera.height()) {
    throw DataError(file.string() + ": has " + std::to_string(raw.width) + " x " +
                    std::to_string(raw.height) + " pixels, expected " + std::to_string(camera.width()) +
                    " x " + std::to_string(camera.height()) + " as the rig's thermal camera has");
  }
  BoardImage image{raw.width, raw.height, raw.celsius};
  if (image.values.empty()) image.values.assign(raw.counts.begin(), raw.counts.end());
  fillUnknown(image.values, file);
  return image;
}

BoardImage readVisibleBoard(const std::filesystem::path& file, const std::string& named_by,
                            const Camera& camera) {
  const VisiblePicture picture = readVisiblePicture(file, named_by, camera);
  return {picture.width, picture.height, {picture.luminance.begin(), picture.luminance.end()}};
}

std::optional<BoardView> findBoard(const BoardImage& image, const CalibrationBoard& board) {
  if (board.pattern == CalibrationBoard::Pattern::asymmetric_circles)
    return findCircles(image, {board.columns, board.rows});
  return findChessboard(image, {board.columns, board.rows});
}

BoardView markedBoard(const BoardImage& image, const std::vector<Eigen::Vector2d>& corners,
                      const CalibrationBoard& board) {
  constexpr double kMarked = 1.0;  // px, one sigma of a click
  const auto at = [&](int row, int column) {
    return corners[static_cast<std::size_t>(row * board.columns + column)];
  };
  BoardView view;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const int left = std::min(column, board.columns - 2), above = std::min(row, board.rows - 2);
      std::optional<BoardCorner> refined;
      if (board.pattern == CalibrationBoard::Pattern::chessboard) {
        refined = refineCorner(image, {at(row, column), at(row, left + 1) - at(row, left),
                                       at(above + 1, column) - at(above, column)});
      }
      view.push_back(refined.value_or(
          BoardCorner{at(row, column), kMarked * kMarked * Eigen::Matrix2d::Identity(), 0.0}));
    }
  }
  return view;
}

}  // namespace thermovox
