#include "apps/calibration_job.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "apps/board_images.hpp"
#include "io/capture_laser.hpp"
#include "io/corner_file.hpp"
#include "io/parallel_for.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

bool anyCapture(const CaptureFolder& folder, std::optional<fs::path> CaptureFiles::*file) {
  return std::any_of(folder.captures.begin(), folder.captures.end(),
                     [&](const CaptureFiles& capture) { return (capture.*file).has_value(); });
}

const Camera& cameraOf(const Rig& rig, CalibrationCamera camera) {
  return camera == CalibrationCamera::thermal ? rig.thermal_camera->camera : rig.visible_camera->camera;
}

const Pose& poseOf(const Rig& rig, CalibrationCamera camera) {
  return camera == CalibrationCamera::thermal ? rig.thermal_camera->T_body_camera
                                              : rig.visible_camera->T_body_camera;
}

/// Throws ConfigError unless the rig has what the captures are to be of, and the captures have it too.
void requireCamera(const CaptureFolder& folder, CalibrationCamera camera) {
  const bool thermal = camera == CalibrationCamera::thermal;
  const std::string key = thermal ? "thermal_camera" : "visible_camera";
  const std::string other = thermal ? "visible" : "thermal";
  const bool has = thermal ? folder.rig.thermal_camera.has_value() : folder.rig.visible_camera.has_value();
  if (!has) {
    throw ConfigError(folder.rig_file.string() + ": has no " + key + ", expected one, or --camera " + other);
  }
  if (!anyCapture(folder, thermal ? &CaptureFiles::thermal : &CaptureFiles::visible)) {
    throw ConfigError(folder.folder.string() + ": no capture has a " + (thermal ? "thermal" : "visible") +
                      " image, expected some, or --camera " + other);
  }
}

/// Which cameras take part, the reference camera first.
std::vector<CalibrationCamera> camerasFor(const CaptureFolder& folder, const CalibrationJob& job) {
  const CalibrationCamera reference =
      job.task == CalibrationTask::stereo ? CalibrationCamera::thermal : job.camera;
  requireCamera(folder, reference);
  std::vector<CalibrationCamera> cameras{reference};
  if (job.task == CalibrationTask::stereo) requireCamera(folder, CalibrationCamera::visible);
  const bool helps = job.task == CalibrationTask::laser && reference == CalibrationCamera::thermal &&
                     folder.rig.visible_camera && anyCapture(folder, &CaptureFiles::visible);
  if (job.task == CalibrationTask::stereo || helps) cameras.push_back(CalibrationCamera::visible);
  return cameras;
}

LaserGuess laserGuess(const CaptureFolder& folder, const CalibrationJob& job, const Pose& T_body_reference) {
  const std::size_t lasers = folder.rig.lasers.size();
  if (static_cast<std::size_t>(job.laser) >= lasers) {
    throw ConfigError(folder.rig_file.string() + ": has " + std::to_string(lasers) +
                      " laser(s), expected number " + std::to_string(job.laser) + " counted from 0");
  }
  if (!anyCapture(folder, &CaptureFiles::laser)) {
    throw ConfigError(folder.folder.string() + ": no capture has a laser file, expected some");
  }
  const Laser& laser = folder.rig.lasers[static_cast<std::size_t>(job.laser)];
  return {laser.kind, T_body_reference.inverse() * laser.T_body_laser, laser.range_sigma,
          laser.range_bias_sigma};
}

std::optional<BoardView> readView(const CaptureFolder& folder, const CaptureFiles& files,
                                  CalibrationCamera camera) {
  const bool thermal = camera == CalibrationCamera::thermal;
  const auto& image = thermal ? files.thermal : files.visible;
  const auto& corners = thermal ? files.thermal_corners : files.visible_corners;
  if (!image) return std::nullopt;
  const Camera& lens = cameraOf(folder.rig, camera);
  const BoardImage pixels =
      thermal ? readThermalBoard(*image, files.place, lens) : readVisibleBoard(*image, files.place, lens);
  if (corners) return markedBoard(pixels, readCorners(*corners, folder.board, files.place), folder.board);
  return findBoard(pixels, folder.board);
}

std::vector<Eigen::Vector3d> readReturns(const CaptureFiles& files, const Laser& laser) {
  std::vector<Eigen::Vector3d> returns;
  for (const Reading& reading : readCaptureLaser(files, laser)) {
    for (const LaserReturn& echo : reading.returns) returns.push_back(echo.p_laser);
  }
  return returns;
}

/// All images are searched, all laser files read; in parallel, each capture into its own place.
void readCaptures(CalibrationRun& run, const CalibrationJob& job) {
  const std::vector<CaptureFiles>& files = run.folder.captures;
  run.input.captures.resize(files.size());
  std::mutex telling;
  std::size_t done = 0;
  parallelFor(files.size(), job.threads, [&](std::size_t i) {
    BoardCapture& capture = run.input.captures[i];
    capture.name = files[i].name;
    for (const CalibrationCamera camera : run.cameras)
      capture.views.push_back(readView(run.folder, files[i], camera));
    if (run.input.laser && files[i].laser)
      capture.returns_laser =
          readReturns(files[i], run.folder.rig.lasers[static_cast<std::size_t>(job.laser)]);
    const std::lock_guard lock(telling);
    ++done;
    if (job.progress)
      job.progress("boards in the images", static_cast<double>(done) / static_cast<double>(files.size()));
  });
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t camera = 0; camera < run.cameras.size(); ++camera) {
      const auto& image =
          run.cameras[camera] == CalibrationCamera::thermal ? files[i].thermal : files[i].visible;
      if (image && !run.input.captures[i].views[camera])
        run.without_board.push_back(image->filename().string());
    }
  }
}

/// Matrix6d of (rotation, translation) about axes that a rotation turns.
Matrix6d turned(const Matrix6d& covariance, const Eigen::Matrix3d& R) {
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = R;
  turn.bottomRightCorner<3, 3>() = R;
  return turn * covariance * turn.transpose();
}

/// The covariance of T_reference_camera (along the reference's axes) by that of its inverse (along the
/// camera's): w' = -R w, t' = -R v - [R t]x R w.
Matrix6d inverseCovariance(const Matrix6d& covariance, const Pose& T_camera_reference) {
  const Eigen::Matrix3d R = T_camera_reference.matrix().transpose();
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = -R;
  J.bottomRightCorner<3, 3>() = -R;
  J.bottomLeftCorner<3, 3>() = -skew(R * T_camera_reference.translation) * R;
  return J * covariance * J.transpose();
}

}  // namespace

CalibrationRun readCalibration(const fs::path& captures, const CalibrationJob& job) {
  CalibrationRun run{.folder = openCaptures(captures)};
  run.cameras = camerasFor(run.folder, job);
  run.input.board = run.folder.board;
  const Pose& T_body_reference = poseOf(run.folder.rig, run.cameras.front());
  for (const CalibrationCamera camera : run.cameras) {
    run.input.cameras.push_back({cameraOf(run.folder.rig, camera).intrinsics(),
                                 T_body_reference.inverse() * poseOf(run.folder.rig, camera), job.lens});
  }
  if (job.task == CalibrationTask::laser) run.input.laser = laserGuess(run.folder, job, T_body_reference);
  readCaptures(run, job);
  return run;
}

void calibrate(CalibrationRun& run, const CalibrationJob& job) {
  try {
    run.result = calibrateRig(run.input, {.progress = job.progress});
  } catch (const UnobservableError& refusal) {
    run.refused = refusal.what();
    throw;
  }
}

Rig calibratedRig(const CalibrationRun& run, const CalibrationJob& job) {
  Rig rig = run.folder.rig;
  const RigCalibration& result = run.result;
  const Pose T_body_reference = poseOf(rig, run.cameras.front());
  for (std::size_t i = 0; i < run.cameras.size(); ++i) {
    const Camera camera(result.estimate.cameras[i]);
    const CameraVerdict& verdict = result.cameras[i];
    const bool thermal = run.cameras[i] == CalibrationCamera::thermal;
    (thermal ? rig.thermal_camera->camera : rig.visible_camera->camera) = camera;
    if (verdict.covariance_intrinsics.size() > 0) {
      (thermal ? rig.thermal_camera->covariance_intrinsics : rig.visible_camera->covariance_intrinsics) =
          verdict.covariance_intrinsics;
    }
    if (i == 0 || !verdict.pose_estimated) continue;
    const Pose& T_camera_reference = result.estimate.T_camera_reference[i];
    rig.visible_camera->T_body_camera = T_body_reference * T_camera_reference.inverse();
    rig.visible_camera->covariance_body_camera =
        turned(inverseCovariance(verdict.covariance_pose, T_camera_reference), T_body_reference.matrix());
  }
  if (result.laser && result.laser->observable) {
    Laser& laser = rig.lasers[static_cast<std::size_t>(job.laser)];
    laser.T_body_laser = T_body_reference * result.estimate.T_reference_laser;
    laser.covariance_body_laser = turned(result.laser->covariance, T_body_reference.matrix());
  }
  return rig;
}

}  // namespace thermovox
