#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "apps/simulate/capture_options.hpp"
#include "projection/calibration_board.hpp"
#include "projection/pose.hpp"

namespace thermovox::simulate {

/// A side of the board as one looks at it.
enum class BoardSide { left, right, top, bottom };

/// Where the board stood during one capture; the board's frame is that of CalibrationBoard.
struct BoardCapture {
  Pose T_body_board;              ///< while the images were taken: the truth
  Pose T_body_board_at_laser;     ///< while the laser measured: another one where the capture is spoiled
  double range_bias = 0.0;        ///< common to all ranges of the capture, metres
  bool spoiled = false;           ///< the board moved in between
  std::optional<BoardSide> edge;  ///< the side that the beam grazes, if it is to graze one
};

/// A chessboard held before a rig in a room, once for each capture. Where it stands in a plain capture
/// depends on the seed and the capture's number, not on how many there are.
class CaptureScene {
 public:
  /// Throws ConfigError for an option that cannot be used.
  explicit CaptureScene(const CaptureOptions& options);

  [[nodiscard]] const CaptureOptions& options() const { return options_; }
  [[nodiscard]] const Rig& trueRig() const { return true_rig_; }
  [[nodiscard]] const Rig& guessedRig() const { return guessed_rig_; }
  [[nodiscard]] const CalibrationBoard& board() const { return board_; }
  /// The plain captures first, then those of edges.
  [[nodiscard]] const std::vector<BoardCapture>& captures() const { return captures_; }

  /// From the middle of the plate to the first inner corner, metres.
  [[nodiscard]] Eigen::Vector3d firstCorner() const;
  /// Of plain plate beyond the outer squares, metres.
  [[nodiscard]] double margin() const;

  /// How far from the laser a ray (unit length, laser frame) meets the plate of this capture, where the laser
  /// sees it; `off_spot` moves the place where it meets the plate's plane, metres along the board's axes.
  [[nodiscard]] std::optional<double> rangeOfPlate(const BoardCapture& capture,
                                                   const Eigen::Vector3d& d_laser,
                                                   const Eigen::Vector2d& off_spot = {0.0, 0.0}) const;
  /// How far from the laser the ray meets the room behind it.
  [[nodiscard]] double rangeOfRoom(const Eigen::Vector3d& d_laser) const;

 private:
  CaptureOptions options_;
  Rig true_rig_;
  Rig guessed_rig_;
  CalibrationBoard board_;
  Eigen::Vector3d room_low_;   ///< body frame, metres
  Eigen::Vector3d room_high_;  ///< likewise
  std::vector<BoardCapture> captures_;
};

}  // namespace thermovox::simulate
