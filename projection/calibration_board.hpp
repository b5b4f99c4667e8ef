#pragma once

namespace thermovox {

/// A calibration target: a regular pattern on a flat plate, in the middle of it. The board's frame has its
/// origin in the middle too, x along a row of the pattern, y from row to row (right and down as one looks at
/// it), z into the plate; metres.
struct CalibrationBoard {
  enum class Pattern {
    chessboard,          ///< counted are inner corners, where four squares meet
    asymmetric_circles,  ///< every other row is shifted by half; OpenCV's counting: `columns` in a row
  };
  Pattern pattern = Pattern::chessboard;
  int columns = 0;      ///< corners or circles in a row
  int rows = 0;         ///< rows of them
  double square = 0.0;  ///< edge of a square; of circles half the distance of neighbours in a row
  double width = 0.0;   ///< of the plate along x; 0 where it is not known
  double height = 0.0;  ///< of the plate along y; 0 where it is not known
};

}  // namespace thermovox
