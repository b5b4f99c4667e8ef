#include "tests/benchmark/calibration_trials.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "apps/simulate/capture_laser.hpp"
#include "apps/simulate/capture_scene.hpp"
#include "calibration/board_edges.hpp"
#include "calibration/board_points.hpp"
#include "calibration/rig_calibration.hpp"
#include "projection/error.hpp"
#include "tests/benchmark/cramer_rao.hpp"

namespace thermovox::bench {
namespace {

constexpr double kVisibleSigma = 0.1;  // px of the visible camera
constexpr double kOnBoard = 0.05;      // metres off its plane: ten sigmas and more
constexpr double kGrazing = 0.0012;    // metres: a grazing beam meets its edge within 2 mm, anywhere there

simulate::CaptureOptions optionsOf(const TrialSet& set, std::uint64_t seed) {
  simulate::CaptureOptions options;
  options.laser = set.laser;
  options.captures = set.captures;
  options.edge_captures = set.edge_captures;
  options.spoiled = set.spoiled;
  options.seed = seed;
  options.capture_bias_sigma = set.capture_bias_sigma;
  return options;
}

/// The board's points in a camera, each off by Gaussian noise.
BoardView noisyView(const std::vector<Eigen::Vector3d>& points, const Camera& camera,
                    const Pose& T_camera_board, double sigma, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0.0, sigma);
  BoardView view;
  for (const Eigen::Vector3d& point : points) {
    Eigen::Vector2d pixel = camera.projectUnbounded(T_camera_board * point).value();
    for (int i = 0; i < 2; ++i) pixel[i] += noise(random);
    view.push_back({pixel, sigma * sigma * Eigen::Matrix2d::Identity(), 10.0});
  }
  return view;
}

std::vector<Eigen::Vector3d> returnsOf(const simulate::CaptureScene& scene, std::size_t capture) {
  std::vector<Eigen::Vector3d> returns;
  for (const Reading& reading : simulate::measureCapture(scene, capture)) {
    for (const LaserReturn& echo : reading.returns) returns.push_back(echo.p_laser);
  }
  return returns;
}

/// A scene with its cameras as the estimator sees them: T of each from the thermal one, and the truth.
class Trial {
 public:
  Trial(const TrialSet& set, std::uint64_t seed)
      : set_(set), scene_(optionsOf(set, seed)), board_(scene_.board()), random_(seed) {
    if (set.edges == TrialSet::Edges::unknown) board_.width = board_.height = 0.0;
    const Rig &truth = scene_.trueRig(), &guess = scene_.guessedRig();
    cameras_.push_back(truth.thermal_camera->camera);
    T_camera_reference_.emplace_back();
    input_.cameras.push_back({guess.thermal_camera->camera.intrinsics(), {}});
    if (set.cameras == TrialSet::Cameras::both) {
      cameras_.push_back(truth.visible_camera->camera);
      T_camera_reference_.push_back(truth.visible_camera->T_body_camera.inverse() *
                                    truth.thermal_camera->T_body_camera);
      input_.cameras.push_back(
          {guess.visible_camera->camera.intrinsics(),
           guess.thermal_camera->T_body_camera.inverse() * guess.visible_camera->T_body_camera});
    }
    const Laser& laser = guess.lasers.front();
    input_.laser = LaserGuess{laser.kind, guess.thermal_camera->T_body_camera.inverse() * laser.T_body_laser,
                              laser.range_sigma, 0.0};
    input_.board = board_;
  }

  CalibrationTrial run() {
    const std::vector<Eigen::Vector3d> points = boardPoints(board_);
    const Pose T_reference_body = scene_.trueRig().thermal_camera->T_body_camera.inverse();
    for (std::size_t i = 0; i < scene_.captures().size(); ++i) {
      BoardCapture capture{.name = std::to_string(i)};
      for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
        const Pose T_camera_board =
            T_camera_reference_[camera] * T_reference_body * scene_.captures()[i].T_body_board;
        capture.views.emplace_back(noisyView(points, cameras_[camera], T_camera_board,
                                             camera == 0 ? set_.corner_sigma_px : kVisibleSigma, random_));
      }
      capture.returns_laser = returnsOf(scene_, i);
      input_.captures.push_back(std::move(capture));
    }
    return judged(calibrateRig(input_, {}));
  }

 private:
  [[nodiscard]] Pose trueLaser() const {
    return scene_.trueRig().thermal_camera->T_body_camera.inverse() *
           scene_.trueRig().lasers.front().T_body_laser;
  }
  [[nodiscard]] Matrix6d bound() const;
  [[nodiscard]] CalibrationTrial judged(const RigCalibration& result) const;

  const TrialSet& set_;
  simulate::CaptureScene scene_;
  CalibrationBoard board_;
  std::mt19937_64 random_;
  std::vector<Camera> cameras_;
  std::vector<Pose> T_camera_reference_;
  CalibrationInput input_;
};

Matrix6d Trial::bound() const {
  MeasuredSetUp set_up{.laser = set_.laser,
                       .T_reference_laser = trueLaser(),
                       .range_sigma = scene_.options().range_sigma,
                       .range_bias_sigma = set_.capture_bias_sigma};
  set_up.points = boardPoints(board_);
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    set_up.cameras.push_back(cameras_[camera].intrinsics());
    set_up.T_camera_reference.push_back(T_camera_reference_[camera]);
    set_up.corner_sigma_px.push_back(camera == 0 ? set_.corner_sigma_px : kVisibleSigma);
  }
  const Pose T_reference_body = scene_.trueRig().thermal_camera->T_body_camera.inverse();
  for (std::size_t i = 0; i < scene_.captures().size(); ++i) {
    const simulate::BoardCapture& truth = scene_.captures()[i];
    MeasuredCapture capture{.T_reference_board = T_reference_body * truth.T_body_board};
    const Pose T_board_laser = capture.T_reference_board.inverse() * trueLaser();
    for (const Eigen::Vector3d& p : input_.captures[i].returns_laser) {
      const bool meets = scene_.rangeOfPlate(truth, p.normalized()) || truth.edge;
      if (!truth.spoiled && meets && std::abs((T_board_laser * p).z()) < kOnBoard)
        capture.rays.push_back(p.normalized());
    }
    if (set_.edges == TrialSet::Edges::used && !truth.spoiled) {
      capture.edges =
          edgeSides(input_.captures[i].returns_laser, set_.laser,
                    trueLaser().inverse() * capture.T_reference_board, board_, scene_.options().range_sigma);
      for (EdgeSide& side : capture.edges) {
        if (set_.laser == LaserKind::beam) side.crossings.front().sigma = kGrazing;
      }
    }
    set_up.captures.push_back(std::move(capture));
  }
  return cramerRaoBound(set_up);
}

CalibrationTrial Trial::judged(const RigCalibration& result) const {
  CalibrationTrial trial{.observable = result.laser->observable};
  for (const DroppedCapture& dropped : result.dropped) {
    const bool spoiled = scene_.captures()[std::stoul(dropped.capture)].spoiled;
    ++(spoiled ? trial.spoiled_found : trial.sound_dropped);
  }
  if (!trial.observable) return trial;
  const Pose truth = trueLaser(), found = result.estimate.T_reference_laser;
  const Eigen::AngleAxisd turn(found.rotation * truth.rotation.conjugate());
  Vector6d error;
  error << turn.angle() * turn.axis(), found.translation - truth.translation;
  if (set_.laser == LaserKind::beam) {  // only where it points can be known
    const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
    error.head<3>() = (truth.rotation * axis).cross(found.rotation * axis);
  }
  const Matrix6d least = bound();
  trial.rotation_error = error.head<3>().norm();
  trial.translation_error = error.tail<3>().norm();
  trial.rotation_bound = std::sqrt(least.topLeftCorner<3, 3>().trace());
  trial.translation_bound = std::sqrt(least.bottomRightCorner<3, 3>().trace());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(result.laser->covariance);
  const int first = set_.laser == LaserKind::beam ? 1 : 0;  // the roll
  for (int i = first; i < 6; ++i)
    trial.nees += std::pow(eigen.eigenvectors().col(i).dot(error), 2) / eigen.eigenvalues()[i] / (6 - first);
  const auto &lens = result.estimate.cameras.front().parameters,
             &exact = cameras_.front().intrinsics().parameters;
  trial.focal_error_px = std::max(std::abs(lens[kFx] - exact[kFx]), std::abs(lens[kFy] - exact[kFy]));
  trial.centre_error_px = std::max(std::abs(lens[kCx] - exact[kCx]), std::abs(lens[kCy] - exact[kCy]));
  return trial;
}

}  // namespace

std::vector<TrialSet> trialSets() {
  using Edges = TrialSet::Edges;
  using Cameras = TrialSet::Cameras;
  return {
      {.name = "3D, planes", .laser = LaserKind::cloud},
      {.name = "3D, planes and edges", .laser = LaserKind::cloud, .edges = Edges::used},
      {.name = "2D, lines", .laser = LaserKind::scan},
      {.name = "2D, lines and edges", .laser = LaserKind::scan, .edges = Edges::used},
      {.name = "1D, averaged", .laser = LaserKind::beam, .capture_bias_sigma = 0.003},
      {.name = "1D, averaged, 16 edges",
       .laser = LaserKind::beam,
       .edge_captures = 16,
       .capture_bias_sigma = 0.003,
       .edges = Edges::used},
      {.name = "3D, both cameras, no bias",
       .laser = LaserKind::cloud,
       .capture_bias_sigma = 0.0,
       .cameras = Cameras::both,
       .edges = Edges::used},
      {.name = "2D, both cameras, no bias",
       .laser = LaserKind::scan,
       .capture_bias_sigma = 0.0,
       .cameras = Cameras::both,
       .edges = Edges::used},
      {.name = "1D, both cameras, no bias",
       .laser = LaserKind::beam,
       .captures = 40,
       .capture_bias_sigma = 0.0,
       .cameras = Cameras::both,
       .edges = Edges::used},
      {.name = "lens, 30 captures", .laser = LaserKind::cloud, .captures = 30, .edges = Edges::used},
      {.name = "3D, 4 of 24 spoiled",
       .laser = LaserKind::cloud,
       .captures = 24,
       .spoiled = 4,
       .edges = Edges::used},
      {.name = "2D, 4 of 24 spoiled",
       .laser = LaserKind::scan,
       .captures = 24,
       .spoiled = 4,
       .edges = Edges::used},
      {.name = "1D, 6 of 40 spoiled",
       .laser = LaserKind::beam,
       .captures = 40,
       .spoiled = 6,
       .capture_bias_sigma = 0.003},
  };
}

CalibrationTrial calibrationTrial(const TrialSet& set, std::uint64_t seed) {
  return Trial(set, seed).run();
}

/// None for a seed whose rig leaves the board no place that all instruments see.
std::optional<CalibrationTrial> trialIfPossible(const TrialSet& set, std::uint64_t seed) {
  try {
    return calibrationTrial(set, seed);
  } catch (const ConfigError&) {
    return std::nullopt;
  }
}

CalibrationSummary calibrationTrials(const TrialSet& set, std::uint64_t first_seed, std::size_t runs) {
  CalibrationSummary sum;
  for (std::size_t run = 0; run < runs; ++run) {
    const std::optional<CalibrationTrial> tried = trialIfPossible(set, first_seed + run);
    if (!tried) continue;
    const CalibrationTrial& trial = *tried;
    ++sum.trials;
    sum.spoiled_found += trial.spoiled_found;
    sum.sound_dropped += trial.sound_dropped;
    if (!trial.observable) continue;
    ++sum.observable;
    sum.rotation_error += std::pow(trial.rotation_error, 2);
    sum.rotation_bound += std::pow(trial.rotation_bound, 2);
    sum.translation_error += std::pow(trial.translation_error, 2);
    sum.translation_bound += std::pow(trial.translation_bound, 2);
    sum.nees += trial.nees;
    sum.focal_error_px = std::max(sum.focal_error_px, trial.focal_error_px);
    sum.centre_error_px = std::max(sum.centre_error_px, trial.centre_error_px);
  }
  const auto n = static_cast<double>(std::max<std::size_t>(1, sum.observable));
  for (double* mean :
       {&sum.rotation_error, &sum.rotation_bound, &sum.translation_error, &sum.translation_bound})
    *mean = std::sqrt(*mean / n);
  sum.nees /= n;
  return sum;
}

}  // namespace thermovox::bench
