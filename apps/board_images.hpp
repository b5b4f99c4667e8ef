#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calibration/board_capture.hpp"
#include "calibration/board_image.hpp"
#include "projection/calibration_board.hpp"
#include "projection/camera.hpp"

namespace thermovox {

/// The pixels of a thermal image as they are stored, counts or temperatures; of a recording the first frame.
/// Throws DataError naming the file when it cannot be read or has another size than the camera has.
[[nodiscard]] BoardImage readThermalBoard(const std::filesystem::path& file, const std::string& named_by,
                                          const Camera& camera);

/// The brightness of a visible picture; the same.
[[nodiscard]] BoardImage readVisibleBoard(const std::filesystem::path& file, const std::string& named_by,
                                          const Camera& camera);

/// The board in an image by its pattern's detector.
[[nodiscard]] std::optional<BoardView> findBoard(const BoardImage& image, const CalibrationBoard& board);

/// A board whose corners were marked by hand (pixels): each is refined in the image where that succeeds, and
/// else stays where it was marked, with a sigma of one pixel.
[[nodiscard]] BoardView markedBoard(const BoardImage& image, const std::vector<Eigen::Vector2d>& corners,
                                    const CalibrationBoard& board);

}  // namespace thermovox
