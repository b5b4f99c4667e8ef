#include "calibration/board_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "io/raw_thermal_image.hpp"
#include "io/thermal_recording.hpp"
#include "projection/error.hpp"
#include "tests/calibration/rendered_board.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox::test {
namespace {

constexpr ChessboardGrid kGrid{9, 6};

/// The largest distance of a corner from its truth, whichever corner of the board comes first; infinite where
/// no board is found.
double worstError(const RenderedBoard& board, const BoardImage& image) {
  const auto corners = findChessboard(image, kGrid);
  if (!corners || corners->size() != 54) return std::numeric_limits<double>::infinity();
  double worst[2] = {0.0, 0.0};
  for (int i = 0; i < 54; ++i) {
    const Eigen::Vector2d truth = board.cornerAt(i % 9, i / 9);
    const auto k = static_cast<std::size_t>(i);
    worst[0] = std::max(worst[0], ((*corners)[k].pixel - truth).norm());
    worst[1] = std::max(worst[1], ((*corners)[53 - k].pixel - truth).norm());
  }
  return std::min(worst[0], worst[1]);
}

RenderedBoard boardOf(double warm) {
  return {.pixel_from_board = homographyOf(9.0, 8.0, {35.0, 25.0}, {0.003, 0.002}), .warm = warm};
}

TEST(FindChessboard, FindsBothPolarities) {
  for (const double warm : {8.0, 2.0, -6.0}) {
    EXPECT_LT(worstError(boardOf(warm), imageOf(boardOf(warm))), 0.15) << warm;
  }
}

TEST(FindChessboard, FindsABoardUnderALampsHotSpot) {
  const RenderedBoard board = boardOf(1.5);
  BoardImage image = imageOf(board);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double square = (u - 70.0) * (u - 70.0) + (v - 50.0) * (v - 50.0);
      image.values[static_cast<std::size_t>(v * image.width + u)] +=
          static_cast<float>(12.0 * std::exp(-square / 1800.0));
    }
  }
  EXPECT_LT(worstError(board, image), 0.4);
}

TEST(FindChessboard, FindsSmallSquares) {
  RenderedBoard board = boardOf(6.0);
  board.pixel_from_board = homographyOf(5.0, -6.0, {50.0, 45.0});
  EXPECT_LT(worstError(board, imageOf(board)), 0.25);
}

TEST(FindChessboard, WithoutAWholeBoardFindsNone) {
  EXPECT_FALSE(findChessboard(imageOf(boardOf(0.0)), kGrid));
  RenderedBoard cut = boardOf(8.0);
  cut.pixel_from_board = homographyOf(14.0, 0.0, {40.0, 70.0});  // its last rows are below the image
  EXPECT_FALSE(findChessboard(imageOf(cut), kGrid));
}

TEST(FindChessboard, RefusesWhatIsNoImageAndNoGrid) {
  const BoardImage image = imageOf(boardOf(8.0));
  EXPECT_THROW((void)findChessboard(image, {2, 6}), ConfigError);
  EXPECT_THROW((void)findChessboard({}, kGrid), ConfigError);
  EXPECT_THROW((void)findChessboard({160, 120, {1.0F}}, kGrid), ConfigError);
  BoardImage holed = image;
  holed.values[77] = std::nanf("");
  EXPECT_THROW((void)findChessboard(holed, kGrid), ConfigError);
}

/// Counts or temperatures of a thermal file.
BoardImage boardImageOf(const std::filesystem::path& file) {
  const RawThermalImage raw = openThermalRecording(file, {})->read(0);
  BoardImage image{raw.width, raw.height, {}};
  if (raw.counts.empty()) {
    image.values = raw.celsius;
  } else {
    image.values.assign(raw.counts.begin(), raw.counts.end());
  }
  return image;
}

TEST(FindChessboard, FindsAllLampHeatedBoardsOfARealPair) {
  THERMOVOX_NEEDS_RECORDINGS();
  std::size_t images = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*recordings() / "boards" / "vims")) {
    if (entry.path().extension() != ".tiff") continue;
    ++images;
    EXPECT_TRUE(findChessboard(boardImageOf(entry.path()), kGrid)) << entry.path();
  }
  EXPECT_EQ(images, 8U);
}

}  // namespace
}  // namespace thermovox::test
