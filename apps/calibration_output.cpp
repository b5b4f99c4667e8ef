#include "apps/calibration_output.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace thermovox {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array<const char*, kCameraParameters> kBrownConrady{"fx", "fy", "cx", "cy", "k1", "k2",
                                                                   "p1", "p2", "k3", "k4", "k5", "k6"};
constexpr std::array<const char*, kCameraParameters> kKannalaBrandt{"fx", "fy", "cx", "cy", "k1", "k2",
                                                                    "k3", "k4", "",   "",   "",   ""};

const char* nameOf(CalibrationCamera camera) {
  return camera == CalibrationCamera::thermal ? "thermal" : "visible";
}

const char* parameterName(LensModel model, std::size_t i) {
  return (model == LensModel::kannala_brandt ? kKannalaBrandt : kBrownConrady)[i];
}

double sigmaOf(const CameraVerdict& verdict, std::size_t i) {
  const auto place = static_cast<Eigen::Index>(i);
  return place < verdict.covariance_intrinsics.rows() ? std::sqrt(verdict.covariance_intrinsics(place, place))
                                                      : 0.0;
}

Json poseJson(const Pose& pose) {
  const auto& q = pose.rotation.coeffs();
  const auto& t = pose.translation;
  return {{"translation", {t.x(), t.y(), t.z()}}, {"quaternion_xyzw", {q[0], q[1], q[2], q[3]}}};
}

Json rotationSigmas(const Matrix6d& covariance) {
  Json sigmas = Json::array();
  for (int i = 0; i < 3; ++i) sigmas.push_back(std::sqrt(covariance(i, i)) / kDegree);
  return sigmas;
}

Json translationSigmas(const Matrix6d& covariance) {
  Json sigmas = Json::array();
  for (int i = 3; i < 6; ++i) sigmas.push_back(1e3 * std::sqrt(covariance(i, i)));
  return sigmas;
}

Json cameraJson(const CalibrationRun& run, std::size_t i, const Rig& rig) {
  const CameraVerdict& verdict = run.result.cameras[i];
  const Intrinsics& lens = run.result.estimate.cameras[i];
  Json json{{"camera", nameOf(run.cameras[i])}, {"views", verdict.views},
            {"corners", verdict.corners},       {"corner_outliers", verdict.corner_outliers},
            {"rms_px", verdict.rms_px},         {"estimated", verdict.covariance_intrinsics.size() > 0}};
  const auto parameters = static_cast<std::size_t>(kDistortion + lens.distortion_count);
  for (std::size_t k = 0; k < parameters; ++k) {
    const std::string name = parameterName(lens.model, k);
    json["parameters"][name] = lens.parameters[k];
    json["sigmas"][name] = sigmaOf(verdict, k);
  }
  if (i > 0 && verdict.pose_estimated) {
    json["T_body_camera"] = poseJson(rig.visible_camera->T_body_camera);
    json["rotation_sigma_deg"] = rotationSigmas(rig.visible_camera->covariance_body_camera);
    json["translation_sigma_mm"] = translationSigmas(rig.visible_camera->covariance_body_camera);
  }
  return json;
}

void addLaser(Json& json, const CalibrationRun& run, const CalibrationJob& job, const Rig& rig) {
  const LaserVerdict& verdict = *run.result.laser;
  if (verdict.observable) {
    const Laser& laser = rig.lasers[static_cast<std::size_t>(job.laser)];
    json["T_body_laser"] = poseJson(laser.T_body_laser);
    json["rotation_sigma_deg"] = rotationSigmas(laser.covariance_body_laser);
    json["translation_sigma_mm"] = translationSigmas(laser.covariance_body_laser);
    json["roll_observable"] = verdict.roll_observable;
    json["rms_mm"] = run.result.rms_mm;
    json["range_bias_sigma_mm"] = 1e3 * run.result.range_bias_sigma;
    json["weakest_direction"] = verdict.weakest_direction;
    json["condition"] = verdict.condition;
    json["jackknife_ratio"] = verdict.jackknife_ratio;
    for (const PixelTransfer& transfer : verdict.transfer)
      json["pixel_transfer"].push_back({{"distance", transfer.distance}, {"sigma_px", transfer.sigma_px}});
  }
}

std::string cameraTable(const CalibrationRun& run, std::size_t i) {
  const CameraVerdict& verdict = run.result.cameras[i];
  const Intrinsics& lens = run.result.estimate.cameras[i];
  std::string text = fmt::format(
      "{} camera: {} views, {} corners ({} left out), reprojection error {:.3f} px rms\n",
      nameOf(run.cameras[i]), verdict.views, verdict.corners, verdict.corner_outliers, verdict.rms_px);
  if (verdict.covariance_intrinsics.size() == 0) return text + "  its lens is kept as it was\n";
  for (std::size_t k = 0; k < static_cast<std::size_t>(kDistortion + lens.distortion_count); ++k) {
    const double sigma = sigmaOf(verdict, k);
    text += fmt::format("  {:3} {:12.5f}  {}\n", parameterName(lens.model, k), lens.parameters[k],
                        sigma > 0.0 ? fmt::format("+- {:.5f}", sigma) : "kept");
  }
  return text;
}

std::string poseTable(const std::string& name, const Pose& pose, const Matrix6d& covariance) {
  const auto& t = pose.translation;
  const auto& q = pose.rotation.coeffs();
  std::string text =
      fmt::format("{}: translation {:.5f} {:.5f} {:.5f} m, quaternion xyzw {:.6f} {:.6f} {:.6f} {:.6f}\n",
                  name, t.x(), t.y(), t.z(), q[0], q[1], q[2], q[3]);
  text += fmt::format(
      "  one sigma along the body's axes: rotation {:.3f} {:.3f} {:.3f} deg, translation {:.2f} {:.2f} "
      "{:.2f} mm\n",
      std::sqrt(covariance(0, 0)) / kDegree, std::sqrt(covariance(1, 1)) / kDegree,
      std::sqrt(covariance(2, 2)) / kDegree, 1e3 * std::sqrt(covariance(3, 3)),
      1e3 * std::sqrt(covariance(4, 4)), 1e3 * std::sqrt(covariance(5, 5)));
  return text;
}

std::string laserTable(const CalibrationRun& run, const CalibrationJob& job, const Rig& rig) {
  const LaserVerdict& verdict = *run.result.laser;
  const Laser& laser = rig.lasers[static_cast<std::size_t>(job.laser)];
  std::string text = poseTable("T_body_laser", laser.T_body_laser, laser.covariance_body_laser);
  if (!verdict.roll_observable)
    text += "  a beam's roll about its own axis is no measurement's business: it is the first guess's\n";
  text +=
      fmt::format("  returns {:.1f} mm rms about the boards; ranges of a capture err together by {:.1f} mm\n",
                  run.result.rms_mm, 1e3 * run.result.range_bias_sigma);
  for (const PixelTransfer& transfer : verdict.transfer)
    text += fmt::format("  a point {:g} m away is put {:.2f} px beside its pixel (one sigma)\n",
                        transfer.distance, transfer.sigma_px);
  return text + fmt::format("  weakest: {}\n", verdict.weakest_direction);
}

}  // namespace

std::string unobservableReason(const CalibrationRun& run, const CalibrationJob& job) {
  constexpr double kFocalUnknown = 0.05;  // of the focal length
  if (job.task == CalibrationTask::laser) {
    return run.result.laser->observable ? std::string() : run.result.laser->reason;
  }
  for (std::size_t i = 0; i < run.cameras.size(); ++i) {
    const CameraVerdict& verdict = run.result.cameras[i];
    if (run.input.cameras[i].lens == CameraGuess::Lens::keep) continue;
    if (verdict.covariance_intrinsics.size() == 0) {
      return fmt::format("{} views show the whole board to the {} camera, expected 3 or more", verdict.views,
                         nameOf(run.cameras[i]));
    }
    const double focal = sigmaOf(verdict, kFx) / run.result.estimate.cameras[i].parameters[kFx];
    if (!(focal < kFocalUnknown)) {
      return fmt::format(
          "the focal length of the {} camera is known to {:.0f} % only: tilt the board by 30 to 60 degrees "
          "in "
          "several directions",
          nameOf(run.cameras[i]), 100.0 * focal);
    }
  }
  if (job.task == CalibrationTask::stereo && !run.result.cameras.back().pose_estimated)
    return "no capture shows the board to both cameras, expected three or more";
  return {};
}

std::string calibrationJson(const CalibrationRun& run, const CalibrationJob& job, const Rig& rig) {
  const std::string reason = unobservableReason(run, job);
  Json json;
  if (job.task == CalibrationTask::laser) addLaser(json, run, job, rig);
  json["rms_px"] = run.result.cameras.front().rms_px;
  json["captures_used"] = run.result.used.size();
  json["captures_dropped"] = Json::array();
  for (const DroppedCapture& dropped : run.result.dropped)
    json["captures_dropped"].push_back({{"capture", dropped.capture}, {"reason", dropped.reason}});
  json["images_without_board"] = run.without_board;
  json["observable"] = reason.empty();
  if (!reason.empty()) json["reason"] = reason;
  json["cameras"] = Json::array();
  for (std::size_t i = 0; i < run.cameras.size(); ++i) json["cameras"].push_back(cameraJson(run, i, rig));
  json["warnings"] = run.result.warnings;
  if (run.result.laser) {
    for (const std::string& warning : run.result.laser->warnings) json["warnings"].push_back(warning);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string calibrationTable(const CalibrationRun& run, const CalibrationJob& job, const Rig& rig) {
  std::string text;
  for (std::size_t i = 0; i < run.cameras.size(); ++i) {
    text += cameraTable(run, i);
    if (i > 0 && run.result.cameras[i].pose_estimated)
      text += poseTable("T_body_camera of the visible camera", rig.visible_camera->T_body_camera,
                        rig.visible_camera->covariance_body_camera);
  }
  if (run.result.laser && run.result.laser->observable) text += laserTable(run, job, rig);
  text += fmt::format("{} captures count\n", run.result.used.size());
  for (const DroppedCapture& dropped : run.result.dropped)
    text += fmt::format("  left out {}: {}\n", dropped.capture, dropped.reason);
  for (const std::string& image : run.without_board) text += fmt::format("  no board found in {}\n", image);
  return text;
}

}  // namespace thermovox
