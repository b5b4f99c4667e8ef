#include "apps/simulate/board_placing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/simulate/capture_rig.hpp"
#include "apps/simulate/mounting.hpp"
#include "apps/simulate/random.hpp"
#include "projection/error.hpp"

namespace thermovox::simulate {
namespace {

constexpr double kNearest = 0.5;   // metres
constexpr double kFarthest = 1.2;  // metres: squares of 5 thermal pixels
// Of 576 boards drawn without this rule findChessboard() found all 449 above it and 98 of the 127 below; of
// as many drawn with it, all but four.
constexpr double kShortestSidePx = 4.2;
constexpr double kBeamInside = 0.03;    // metres
constexpr double kShortestChord = 0.1;  // metres
constexpr double kSeenMotion = 0.02;    // metres
constexpr double kOffEdge = 0.002;      // metres: the spot falls on both sides of the edge
constexpr int kTriesAtDistance = 300;   // near boards seldom fit; the distances should still be even
constexpr int kDistances = 300;

Eigen::Vector3d anyDirection(Random& random) {
  return random.normal3().normalized();
}

/// How the board faces the camera: tilted by 45 degrees times sqrt(U) about any line in its plane, so that
/// the normals cover their cone evenly, and turned a bit in its plane.
Eigen::Quaterniond facing(Random& random) {
  const double about = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double tilt = 45.0 * kDegree * std::sqrt(random.uniform());
  const double turn = random.uniform(-15.0, 15.0) * kDegree;
  const Eigen::Vector3d axis(std::cos(about), std::sin(about), 0.0);
  return Eigen::AngleAxisd(tilt, axis) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
}

/// Draws poses by `draw`, of a distance, until `accept` takes one.
template <typename Draw, typename Accept>
Pose drawUntil(Random& random, const Draw& draw, const Accept& accept) {
  for (int i = 0; i < kDistances; ++i) {
    const double distance = random.uniform(kNearest, kFarthest);
    for (int j = 0; j < kTriesAtDistance; ++j) {
      Pose pose = draw(distance);
      if (accept(pose)) return pose;
    }
  }
  throw ConfigError("simulate: found no place for the board before this rig, expected another seed");
}

/// On the plate's rim, half-way along the side, and the way out of the plate and along its side from there.
struct Rim {
  Eigen::Vector2d middle;
  Eigen::Vector2d out;
  Eigen::Vector2d along;  ///< half the side's length
};

Rim rimOf(const CalibrationBoard& board, BoardSide side) {
  const Eigen::Vector2d x(1.0, 0.0), y(0.0, 1.0);
  const double half_width = 0.5 * board.width, half_height = 0.5 * board.height;
  switch (side) {
    case BoardSide::left:
      return {-half_width * x, -x, half_height * y};
    case BoardSide::right:
      return {half_width * x, x, half_height * y};
    case BoardSide::top:
      return {-half_height * y, -y, half_width * x};
    case BoardSide::bottom:
      break;
  }
  return {half_height * y, y, half_width * x};
}

}  // namespace

CalibrationBoard simulatedBoard() {
  CalibrationBoard board;
  board.columns = 9;
  board.rows = 6;
  board.square = 0.04;
  board.width = 0.44;
  board.height = 0.32;
  return board;
}

std::optional<PlaneHit> meetPlane(const Pose& T_board_laser, const Eigen::Vector3d& d_laser) {
  const Eigen::Vector3d& origin = T_board_laser.translation;
  const Eigen::Vector3d d_board = T_board_laser.rotation * d_laser;
  if (!(origin.z() < 0.0 && d_board.z() > 1e-9)) return std::nullopt;  // z points into the plate
  const double range = -origin.z() / d_board.z();
  return PlaneHit{(origin + range * d_board).head<2>(), range};
}

BoardPlacing::BoardPlacing(const Rig& rig, const CalibrationBoard& board) : rig_(rig), board_(board) {}

bool BoardPlacing::inImage(const Camera& camera, const Pose& T_camera_board, double border_px) const {
  // The outline of the squares is a square wider than the corners each way.
  for (int row = -1; row <= board_.rows; ++row) {
    const bool whole_row = row == -1 || row == board_.rows;
    for (int column = -1; column <= board_.columns; column += whole_row ? 1 : board_.columns + 1) {
      const auto pixel = camera.projectUnbounded(T_camera_board * cornerAt(column, row));
      if (!pixel || pixel->minCoeff() < border_px || pixel->x() > camera.width() - 1 - border_px ||
          pixel->y() > camera.height() - 1 - border_px)
        return false;
    }
  }
  return true;
}

/// Of the sides of all squares between inner corners, as the camera sees them, px.
double BoardPlacing::shortestSide(const Camera& camera, const Pose& T_camera_board) const {
  const auto pixelOf = [&](int column, int row) {
    return camera.projectUnbounded(T_camera_board * cornerAt(column, row)).value_or(Eigen::Vector2d::Zero());
  };
  double shortest = std::numeric_limits<double>::infinity();
  for (int row = 0; row < board_.rows; ++row) {
    for (int column = 0; column < board_.columns; ++column) {
      const Eigen::Vector2d pixel = pixelOf(column, row);
      if (column > 0) shortest = std::min(shortest, (pixel - pixelOf(column - 1, row)).norm());
      if (row > 0) shortest = std::min(shortest, (pixel - pixelOf(column, row - 1)).norm());
    }
  }
  return shortest;
}

Eigen::Vector3d BoardPlacing::cornerAt(int column, int row) const {
  return {board_.square * (column - 0.5 * (board_.columns - 1)),
          board_.square * (row - 0.5 * (board_.rows - 1)), 0.0};
}

bool BoardPlacing::inImages(const Pose& T_body_board) const {
  const ThermalCamera& thermal = *rig_.thermal_camera;
  const MountedCamera& visible = *rig_.visible_camera;
  const Pose T_thermal_board = thermal.T_body_camera.inverse() * T_body_board;
  return inImage(thermal.camera, T_thermal_board, 2.0) &&
         shortestSide(thermal.camera, T_thermal_board) >= kShortestSidePx &&
         inImage(visible.camera, visible.T_body_camera.inverse() * T_body_board, 10.0);
}

bool BoardPlacing::underScan(const Pose& T_board_laser) const {
  const Laser& laser = rig_.lasers.front();
  Eigen::AlignedBox2d chord;  // its diagonal is one, as the points of a sweep lie on a line
  for (int i = 0; i < kCaptureScanReadings; ++i) {
    const double angle = laser.angle_min + i * laser.angle_increment;
    const auto hit = meetPlane(T_board_laser, {std::cos(angle), std::sin(angle), 0.0});
    if (hit && std::abs(hit->place.x()) <= 0.5 * board_.width &&
        std::abs(hit->place.y()) <= 0.5 * board_.height)
      chord.extend(hit->place);
  }
  return !chord.isEmpty() && chord.diagonal().norm() >= kShortestChord;
}

bool BoardPlacing::underLaser(const Pose& T_body_board) const {
  const Laser& laser = rig_.lasers.front();
  const Pose T_board_laser = T_body_board.inverse() * laser.T_body_laser;
  const auto hit = meetPlane(T_board_laser, Eigen::Vector3d::UnitX());
  if (!hit) return false;
  switch (laser.kind) {
    case LaserKind::beam:
      return std::abs(hit->place.x()) <= 0.5 * board_.width - kBeamInside &&
             std::abs(hit->place.y()) <= 0.5 * board_.height - kBeamInside;
    case LaserKind::scan:
      return underScan(T_board_laser);
    case LaserKind::cloud:
      break;
  }
  return true;
}

BoardCapture BoardPlacing::place(std::uint64_t seed, std::uint64_t number) const {
  Random random(seed, RandomStream::capture_boards, number);
  const ThermalCamera& thermal = *rig_.thermal_camera;
  const auto draw = [&](double distance) {
    const double u = random.uniform(0.0, thermal.camera.width());
    const double v = random.uniform(0.0, thermal.camera.height());
    const auto ray = thermal.camera.rayFromPixel({u, v});
    const Eigen::Quaterniond R_camera_board = facing(random);
    return thermal.T_body_camera * Pose{R_camera_board, distance * ray.value_or(Eigen::Vector3d::UnitZ())};
  };
  const Pose pose = drawUntil(random, draw, [&](const Pose& T_body_board) {
    return inImages(T_body_board) && underLaser(T_body_board);
  });
  return {.T_body_board = pose, .T_body_board_at_laser = pose};
}

BoardCapture BoardPlacing::placeAtEdge(std::uint64_t seed, std::uint64_t number, BoardSide side) const {
  Random random(seed, RandomStream::capture_boards, number);
  const Pose& T_body_laser = rig_.lasers.front().T_body_laser;
  const Rim rim = rimOf(board_, side);
  const auto draw = [&](double distance) {
    const Eigen::Quaterniond R_body_board =
        (rig_.thermal_camera->T_body_camera.rotation * facing(random)).normalized();
    const Eigen::Vector2d place =
        rim.middle + random.uniform(-0.8, 0.8) * rim.along + random.uniform(-kOffEdge, kOffEdge) * rim.out;
    const Eigen::Vector3d p_body = T_body_laser * Eigen::Vector3d(distance, 0.0, 0.0);
    return Pose{R_body_board, p_body - R_body_board * Eigen::Vector3d(place.x(), place.y(), 0.0)};
  };
  const Pose pose = drawUntil(random, draw, [&](const Pose& T_body_board) { return inImages(T_body_board); });
  return {.T_body_board = pose, .T_body_board_at_laser = pose, .edge = side};
}

void BoardPlacing::spoil(BoardCapture& capture, std::uint64_t seed, std::uint64_t number) const {
  Random random(seed, RandomStream::capture_motion, number);
  const Pose& T_body_laser = rig_.lasers.front().T_body_laser;
  const auto ahead = [&](const Pose& T_body_board) {
    const auto hit = meetPlane(T_body_board.inverse() * T_body_laser, Eigen::Vector3d::UnitX());
    return hit ? hit->range : 0.0;
  };
  const double before = ahead(capture.T_body_board);
  const auto draw = [&](double /*distance*/) {
    const Eigen::Vector3d shift = random.uniform(0.03, 0.08) * anyDirection(random);
    const Eigen::Vector3d turn = random.uniform(3.0, 8.0) * kDegree * anyDirection(random);
    return Pose{(expRotation(turn) * capture.T_body_board.rotation).normalized(),
                capture.T_body_board.translation + shift};
  };
  capture.T_body_board_at_laser = drawUntil(random, draw, [&](const Pose& T_body_board) {
    return underLaser(T_body_board) && std::abs(ahead(T_body_board) - before) >= kSeenMotion;
  });
  capture.spoiled = true;
}

}  // namespace thermovox::simulate
