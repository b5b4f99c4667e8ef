#pragma once

#include <set>
#include <string>

#include "apps/simulate/capture_laser.hpp"
#include "apps/simulate/capture_scene.hpp"
#include "calibration/calibration_input.hpp"
#include "tests/calibration/calibration_scene.hpp"

namespace thermovox::test {

/// A calibration of the simulator's whose truth is known: corners of the true cameras with noise, and what
/// the laser measures of the board and the room.
struct RigTrial {
  LaserKind kind = LaserKind::cloud;
  int captures = 14;
  int spoiled = 0;
  double corner_sigma_px = 0.1;
  double capture_bias_sigma = 0.0;  ///< metres
  std::uint64_t seed = 1;
  enum class Cameras { thermal, both };
  Cameras cameras = Cameras::thermal;
  enum class Laser { measured, silent };
  Laser laser = Laser::measured;

  CalibrationInput input{};
  RigEstimate truth{};
  std::set<std::string> moved{};  ///< names of the captures whose board moved

  /// Draws it.
  void make() {
    simulate::CaptureOptions options;
    options.laser = kind;
    options.captures = captures;
    options.spoiled = spoiled;
    options.seed = seed;
    options.capture_bias_sigma = capture_bias_sigma;
    options.threads = 1;
    const simulate::CaptureScene scene(options);
    takeRig(scene);
    Chance chance(seed + 500);
    for (std::size_t i = 0; i < scene.captures().size(); ++i) addCapture(scene, i, chance);
  }

 private:
  void takeRig(const simulate::CaptureScene& scene) {
    const Rig &rig = scene.trueRig(), &guess = scene.guessedRig();
    const Pose T_reference_body = rig.thermal_camera->T_body_camera.inverse();
    input.board = scene.board();
    input.cameras.push_back({guess.thermal_camera->camera.intrinsics(), {}});
    truth.cameras.push_back(rig.thermal_camera->camera.intrinsics());
    truth.T_camera_reference.emplace_back();
    if (cameras == Cameras::both) {
      input.cameras.push_back(
          {guess.visible_camera->camera.intrinsics(),
           guess.thermal_camera->T_body_camera.inverse() * guess.visible_camera->T_body_camera});
      truth.cameras.push_back(rig.visible_camera->camera.intrinsics());
      truth.T_camera_reference.push_back(rig.visible_camera->T_body_camera.inverse() *
                                         rig.thermal_camera->T_body_camera);
    }
    truth.T_reference_laser = T_reference_body * rig.lasers.front().T_body_laser;
    const Pose T_reference_laser =
        guess.thermal_camera->T_body_camera.inverse() * guess.lasers.front().T_body_laser;
    input.laser = LaserGuess{kind, T_reference_laser, scene.options().range_sigma, 0.0};
  }

  void addCapture(const simulate::CaptureScene& scene, std::size_t i, Chance& chance) {
    const Pose T_reference_board =
        scene.trueRig().thermal_camera->T_body_camera.inverse() * scene.captures()[i].T_body_board;
    truth.T_reference_board.push_back(T_reference_board);
    BoardCapture capture{.name = "capture " + std::to_string(i), .views = {}, .returns_laser = {}};
    for (std::size_t camera = 0; camera < truth.cameras.size(); ++camera) {
      capture.views.emplace_back(viewOf(truth.cameras[camera],
                                        truth.T_camera_reference[camera] * T_reference_board, input.board,
                                        corner_sigma_px, chance));
    }
    if (laser == Laser::measured) {
      for (const Reading& reading : simulate::measureCapture(scene, i)) {
        for (const LaserReturn& echo : reading.returns) capture.returns_laser.push_back(echo.p_laser);
      }
    }
    if (scene.captures()[i].spoiled) moved.insert(capture.name);
    input.captures.push_back(std::move(capture));
  }
};

/// `make`d.
inline RigTrial drawn(RigTrial trial) {
  trial.make();
  return trial;
}

/// A view in the order of the corners that a symmetry of the board leads to.
inline BoardView turnedView(const BoardView& view, const std::vector<std::size_t>& symmetry) {
  BoardView turned;
  for (const std::size_t i : symmetry) turned.push_back(view[i]);
  return turned;
}

}  // namespace thermovox::test
