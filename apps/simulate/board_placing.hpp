#pragma once

#include "apps/simulate/capture_scene.hpp"

namespace thermovox::simulate {

/// The board of all simulated captures: 9 x 6 inner corners, squares of 4 cm, 2 cm of plain plate around.
[[nodiscard]] CalibrationBoard simulatedBoard();

/// Where a ray meets the plate's plane.
struct PlaneHit {
  Eigen::Vector2d place;  ///< board frame, metres
  double range = 0.0;     ///< from the laser, in lengths of the ray's direction
};
/// nullopt for a ray that does not meet the plane, or only from behind.
[[nodiscard]] std::optional<PlaneHit> meetPlane(const Pose& T_board_laser, const Eigen::Vector3d& d_laser);

/// Holds boards before a rig so that a capture is worth taking: 0.5 to 1.2 m off, tilted by up to 45 degrees
/// any way, all of the pattern in both images, its squares nowhere too small in the thermal one to be found,
/// and measured by the laser: a beam 3 cm or more inside the plate, a scan over 10 cm of it or more.
class BoardPlacing {
 public:
  /// Both have to outlive it.
  BoardPlacing(const Rig& rig, const CalibrationBoard& board);

  /// The capture of this number.
  [[nodiscard]] BoardCapture place(std::uint64_t seed, std::uint64_t number) const;
  /// Likewise, its beam within 2 mm of this side of the plate.
  [[nodiscard]] BoardCapture placeAtEdge(std::uint64_t seed, std::uint64_t number, BoardSide side) const;
  /// Moves the board between the images and the laser: by 3 to 8 cm and 3 to 8 degrees, and by 2 cm or more
  /// along the laser's x, which would else measure what it would have measured anyway.
  void spoil(BoardCapture& capture, std::uint64_t seed, std::uint64_t number) const;

 private:
  [[nodiscard]] bool inImages(const Pose& T_body_board) const;
  [[nodiscard]] bool inImage(const Camera& camera, const Pose& T_camera_board, double border_px) const;
  [[nodiscard]] Eigen::Vector3d cornerAt(int column, int row) const;  ///< board frame
  [[nodiscard]] double shortestSide(const Camera& camera, const Pose& T_camera_board) const;
  [[nodiscard]] bool underLaser(const Pose& T_body_board) const;
  [[nodiscard]] bool underScan(const Pose& T_board_laser) const;

  const Rig& rig_;
  const CalibrationBoard& board_;
};

}  // namespace thermovox::simulate
