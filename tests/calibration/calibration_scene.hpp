#pragma once

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "calibration/board_points.hpp"
#include "calibration/board_search.hpp"
#include "calibration/calibration_input.hpp"
#include "calibration/rig_bundle.hpp"
#include "projection/camera.hpp"
#include "projection/pose.hpp"

namespace thermovox::test {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// Deviates of one seed: a test means the same alone and in the suite.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  double normal(double sigma = 1.0) { return std::normal_distribution<double>(0.0, 1.0)(engine_) * sigma; }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Eigen::Vector3d normal3(double sigma = 1.0) {
    const double x = normal(sigma), y = normal(sigma), z = normal(sigma);
    return {x, y, z};
  }
  Pose pose(double turn_sigma, double shift_sigma) {
    const Eigen::Vector3d w = normal3(turn_sigma), v = normal3(shift_sigma);
    return {expRotation(w), v};
  }

 private:
  std::mt19937_64 engine_;
};

inline Pose moved(const Pose& pose, Chance& chance, double turn_sigma, double shift_sigma) {
  const Pose by = chance.pose(turn_sigma, shift_sigma);
  return {(by.rotation * pose.rotation).normalized(), pose.translation + by.translation};
}

/// 8 x 5 inner corners, squares of 6 cm, on a plate of 60 x 42 cm: 3 cm of it are plain.
inline CalibrationBoard plate() {
  CalibrationBoard board;
  board.columns = 8;
  board.rows = 5;
  board.square = 0.06;
  board.width = 0.60;
  board.height = 0.42;
  return board;
}

inline Intrinsics lensOf(LensModel model) {
  Intrinsics lens;
  lens.width_px = 160;
  lens.height_px = 120;
  lens.model = model;
  lens.parameters = {149.2, 148.6, 80.3, 58.8};
  if (model == LensModel::brown_conrady) {
    lens.distortion_count = 5;
    lens.parameters[kDistortion] = -0.24;
    lens.parameters[kDistortion + 1] = 0.09;
    lens.parameters[kDistortion + 2] = 0.0006;
    lens.parameters[kDistortion + 3] = -0.0004;
  } else if (model == LensModel::kannala_brandt) {
    lens.distortion_count = 4;
    lens.parameters[kDistortion] = 0.03;
    lens.parameters[kDistortion + 1] = -0.01;
  }
  return lens;
}

/// A laser beside the camera that looks where the camera does: its x is the camera's z, its z is up.
inline Pose laserBesideCamera() {
  Eigen::Matrix3d R;
  R << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0;
  return {(expRotation({0.02, -0.03, 0.015}) * Eigen::Quaterniond(R)).normalized(), {-0.05, -0.08, 0.01}};
}

/// Boards before the camera, 0.6 to 1.8 m off, tilted by 15 to 45 degrees any way: T_reference_board.
inline std::vector<Pose> boardsHeld(std::size_t count, std::uint64_t seed) {
  Chance chance(seed);
  std::vector<Pose> boards;
  for (std::size_t i = 0; i < count; ++i) {
    const double about = chance.uniform(0.0, 360.0) * kDegree, tilt = chance.uniform(15.0, 45.0) * kDegree;
    const double turn = chance.uniform(-15.0, 15.0) * kDegree, distance = chance.uniform(0.6, 1.8);
    const double right = chance.uniform(-0.05, 0.05), down = chance.uniform(-0.07, 0.02);
    boards.push_back(
        {(expRotation({tilt * std::cos(about), tilt * std::sin(about), 0.0}) * expRotation({0.0, 0.0, turn}))
             .normalized(),
         distance * Eigen::Vector3d(right, down, 1.0)});
  }
  return boards;
}

/// Directions of a laser's rays (unit): a beam's hundred readings, a scan of 0.25 degrees, a cloud of 0.5 x
/// 0.5 degrees of the front.
inline std::vector<Eigen::Vector3d> raysOf(LaserKind kind) {
  if (kind == LaserKind::beam) return std::vector<Eigen::Vector3d>(100, Eigen::Vector3d::UnitX());
  std::vector<Eigen::Vector3d> rays;
  const int high = kind == LaserKind::scan ? 0 : 40, wide = kind == LaserKind::scan ? 360 : 80;
  const double step = (kind == LaserKind::scan ? 0.25 : 0.5) * kDegree;
  for (int row = -high; row <= high; ++row) {
    for (int column = -wide; column <= wide; ++column) {
      const double a = step * column, e = step * row;
      rays.emplace_back(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    }
  }
  return rays;
}

/// How far a ray (unit, laser frame) is from a plate at T_laser_board; none where it passes by.
inline std::optional<double> rangeOfPlate(const Eigen::Vector3d& ray, const Pose& T_laser_board,
                                          const CalibrationBoard& board) {
  const Pose T_board_laser = T_laser_board.inverse();
  const Eigen::Vector3d direction = T_board_laser.rotation * ray;
  const double range = -T_board_laser.translation.z() / direction.z();
  if (!(range > 0.0)) return std::nullopt;
  const Eigen::Vector3d hit = T_board_laser * (range * ray);
  const Eigen::Vector2d half = 0.5 * plateOf(board);
  if (std::abs(hit.x()) > half.x() || std::abs(hit.y()) > half.y()) return std::nullopt;
  return range;
}

/// How far the walls of a room are: a box about the laser, 3 m to every side but 2 m up and down.
inline double rangeOfRoom(const Eigen::Vector3d& ray) {
  return (Eigen::Array3d(3.0, 3.0, 2.0) / ray.array().abs()).minCoeff();
}

struct LaserNoise {
  double sigma = 0.0;  ///< metres
  double bias = 0.0;   ///< metres
};

/// Returns of a plate in a room.
inline ReturnSet returnsOf(const std::vector<Eigen::Vector3d>& rays, const Pose& T_laser_board,
                           const CalibrationBoard& board, const LaserNoise& noise, Chance& chance) {
  ReturnSet returns;
  for (const Eigen::Vector3d& ray : rays) {
    const double range = rangeOfPlate(ray, T_laser_board, board).value_or(rangeOfRoom(ray));
    returns.emplace_back((range + noise.bias + chance.normal(noise.sigma)) * ray);
  }
  return returns;
}

/// A view of the board, each corner off by Gaussian noise.
inline BoardView viewOf(const Intrinsics& lens, const Pose& T_camera_board, const CalibrationBoard& board,
                        double sigma_px, Chance& chance) {
  const double stated = std::max(sigma_px, 1e-3);
  BoardView view;
  for (const Eigen::Vector3d& point : boardPoints(board)) {
    Eigen::Vector2d pixel =
        pixelFromCamera<double>(lens.model, lens.parameters.data(), T_camera_board * point);
    for (int i = 0; i < 2; ++i) pixel[i] += chance.normal(sigma_px);
    view.push_back({pixel, stated * stated * Eigen::Matrix2d::Identity(), 10.0});
  }
  return view;
}

/// Points all around the rim of a plate as crossings of its edges that no noise is in.
inline std::vector<EdgeSide> exactEdges(const Pose& T_laser_board, const CalibrationBoard& board) {
  std::vector<EdgeSide> sides;
  const Eigen::Vector2d half = 0.5 * plateOf(board);
  for (int axis = 0; axis < 2; ++axis) {
    for (const double outwards : {-1.0, 1.0}) {
      EdgeSide side{.crossings = {}, .offset_sigma = 0.002};
      for (const double along : {-0.7, -0.1, 0.5}) {
        Eigen::Vector3d p = Eigen::Vector3d::Zero();
        p[axis] = outwards * half[axis];
        p[1 - axis] = along * half[1 - axis];
        side.crossings.push_back({.ray = (T_laser_board * p).normalized(),
                                  .axis = axis,
                                  .place = outwards * half[axis],
                                  .sigma = 0.003});
      }
      sides.push_back(side);
    }
  }
  return sides;
}

/// A rig and boards, and what its instruments measure of them.
struct BundleScene {
  LaserKind kind = LaserKind::cloud;
  std::size_t captures = 10;
  std::size_t cameras = 1;
  double corner_sigma_px = 0.0;
  double range_sigma = 0.0;
  double range_bias_sigma = 0.0;  ///< of a capture
  std::uint64_t seed = 1;
  enum class Edges { none, exact };
  Edges edges = Edges::none;

  CalibrationBoard board = plate();
  RigEstimate truth{};
  BundleData data{};
  BundleModel model{};

  /// Draws it.
  void make() {
    Chance chance(seed);
    truth.T_reference_laser = laserBesideCamera();
    truth.T_reference_board = boardsHeld(captures, seed);
    for (std::size_t camera = 0; camera < cameras; ++camera) {
      truth.cameras.push_back(lensOf(LensModel::brown_conrady));
      truth.T_camera_reference.push_back(camera == 0 ? Pose{}
                                                     : Pose{expRotation({0.02, -0.05, 0.01}), {0.09, 0, 0}});
      model.free_intrinsics.push_back({kFx, kFy, kCx, kCy, kDistortion, kDistortion + 1});
      model.corner_factor.push_back(1.0);
    }
    data.points = boardPoints(board);
    data.laser = kind;
    for (std::size_t i = 0; i < captures; ++i) addCapture(i, chance);
  }

  [[nodiscard]] Pose laserFromBoard(std::size_t capture) const {
    return truth.T_reference_laser.inverse() * truth.T_reference_board[capture];
  }

 private:
  void addCapture(std::size_t capture, Chance& chance) {
    CaptureObservations seen;
    for (std::size_t camera = 0; camera < cameras; ++camera) {
      const Pose T_camera_board = truth.T_camera_reference[camera] * truth.T_reference_board[capture];
      const BoardView view = viewOf(truth.cameras[camera], T_camera_board, board, corner_sigma_px, chance);
      for (std::size_t i = 0; i < view.size(); ++i) {
        const double sigma = std::max(corner_sigma_px, 0.02);
        seen.corners.push_back({static_cast<int>(camera), static_cast<int>(i), view[i].pixel,
                                sigma * sigma * Eigen::Matrix2d::Identity()});
      }
    }
    const double bias = chance.normal(range_bias_sigma);
    const Pose T_laser_board = laserFromBoard(capture);
    ReturnSet returns;
    for (const Eigen::Vector3d& ray : raysOf(kind)) {
      if (const auto range = rangeOfPlate(ray, T_laser_board, board))
        returns.emplace_back((*range + bias + chance.normal(range_sigma)) * ray);
    }
    seen.plane = planeMoments(returns, kind, std::max(range_sigma, 0.001));
    if (edges == Edges::exact) seen.edges = exactEdges(T_laser_board, board);
    data.captures.push_back(std::move(seen));
    truth.range_bias.push_back(0.0);
  }
};

/// `make`d.
inline BundleScene made(BundleScene scene) {
  scene.make();
  return scene;
}

}  // namespace thermovox::test
