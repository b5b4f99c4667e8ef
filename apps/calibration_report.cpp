#include "apps/calibration_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "apps/calibration_captures.hpp"
#include "apps/calibration_output.hpp"
#include "io/calibration_report.hpp"

namespace thermovox {
namespace {

const char* nameOf(CalibrationCamera camera) {
  return camera == CalibrationCamera::thermal ? "thermal camera" : "visible camera";
}

const char* kindOf(LaserKind kind) {
  return kind == LaserKind::beam ? "beam (1D)" : kind == LaserKind::scan ? "scan (2D)" : "cloud (3D)";
}

std::string taskOf(const CalibrationJob& job) {
  if (job.task == CalibrationTask::laser) return "the laser's pose";
  if (job.task == CalibrationTask::stereo) return "both cameras and how they stand to each other";
  return std::string("the lens of the ") + nameOf(job.camera);
}

std::string boardText(const CalibrationBoard& board) {
  const bool circles = board.pattern == CalibrationBoard::Pattern::asymmetric_circles;
  std::string text = fmt::format("a board with {} x {} {}, {:g} mm apart", board.columns, board.rows,
                                 circles ? "circles" : "inner corners", (circles ? 2e3 : 1e3) * board.square);
  if (board.width > 0.0) text += fmt::format(", {:g} x {:g} mm large", 1e3 * board.width, 1e3 * board.height);
  return text;
}

std::vector<ReportedNumber> intrinsicsOf(const CameraVerdict& verdict, const Intrinsics& lens,
                                         const Intrinsics& guess) {
  static constexpr std::array<const char*, 12> kBrownConrady{"fx", "fy", "cx", "cy", "k1", "k2",
                                                             "p1", "p2", "k3", "k4", "k5", "k6"};
  std::vector<ReportedNumber> numbers;
  for (int i = 0; i < kDistortion + lens.distortion_count; ++i) {
    const auto place = static_cast<std::size_t>(i);
    const bool fisheye = lens.model == LensModel::kannala_brandt && i >= kDistortion;
    ReportedNumber number{.name = fisheye ? fmt::format("k{}", i - kDistortion + 1) : kBrownConrady[place],
                          .unit = i < kDistortion ? "px" : "",
                          .value = lens.parameters[place],
                          .sigma = {},
                          .guess = guess.parameters[place]};
    const bool given = i < verdict.covariance_intrinsics.rows();
    if (given && verdict.covariance_intrinsics(i, i) > 0.0)
      number.sigma = std::sqrt(verdict.covariance_intrinsics(i, i));
    numbers.push_back(std::move(number));
  }
  return numbers;
}

ReportedCamera cameraOf(const CalibrationRun& run, std::size_t i) {
  const Intrinsics& guess = run.input.cameras[i].intrinsics;
  const CameraVerdict verdict = run.refused.empty() ? run.result.cameras[i] : CameraVerdict{};
  const Intrinsics& lens = run.refused.empty() ? run.result.estimate.cameras[i] : guess;
  return {.name = nameOf(run.cameras[i]),
          .width_px = lens.width_px,
          .height_px = lens.height_px,
          .corners = verdict.corners,
          .left_out = verdict.corner_outliers,
          .rms_px = verdict.rms_px,
          .corner_factor = verdict.corner_factor,
          .intrinsics = intrinsicsOf(verdict, lens, guess),
          .covariance = verdict.covariance_intrinsics};
}

void addPoses(CalibrationReport& report, const CalibrationRun& run, const CalibrationJob& job,
              const Rig& rig) {
  if (run.result.laser && run.result.laser->observable) {
    const auto laser = static_cast<std::size_t>(job.laser);
    report.poses.push_back(
        {.name = "T_body_laser",
         .note =
             run.result.laser->roll_observable
                 ? ""
                 : "A beam's roll about its own axis is no measurement's business: it is the first guess's.",
         .pose = rig.lasers[laser].T_body_laser,
         .guess = run.folder.rig.lasers[laser].T_body_laser,
         .covariance = rig.lasers[laser].covariance_body_laser});
  }
  for (std::size_t i = 1; i < run.result.cameras.size(); ++i) {
    if (!run.result.cameras[i].pose_estimated) continue;
    report.poses.push_back({.name = "T_body_camera of the visible camera",
                            .note = "The thermal camera's is kept: it is what the others are measured from.",
                            .pose = rig.visible_camera->T_body_camera,
                            .guess = run.folder.rig.visible_camera->T_body_camera,
                            .covariance = rig.visible_camera->covariance_body_camera});
  }
}

void addLaser(CalibrationReport& report, const CalibrationRun& run) {
  const LaserVerdict& verdict = *run.result.laser;
  report.laser.emplace_back("kind of laser", kindOf(run.input.laser->kind));
  report.laser.emplace_back("captures that count", std::to_string(run.result.used.size()));
  if (!verdict.weakest_direction.empty()) {
    report.laser.emplace_back("weakest direction", verdict.weakest_direction);
    report.laser.emplace_back("its sigma, of what is tolerable (0.2 degrees, 5 mm)",
                              fmt::format("{:.0f} %", 100.0 * verdict.weakest_share));
  }
  if (verdict.condition > 0.0)
    report.laser.emplace_back("best over worst known direction (condition; fine below 100, poor above 1000)",
                              fmt::format("{:.3g}", verdict.condition));
  if (verdict.jackknife_ratio > 0.0)
    report.laser.emplace_back(
        "scatter when each capture in turn is left out, over what the covariance says (jackknife)",
        fmt::format(
            "{:.2f}{}", verdict.jackknife_ratio,
            verdict.jackknife_wins ? ": more than chance makes; the covariance is made as large" : ""));
  if (run.result.rms_mm > 0.0) {
    report.laser.emplace_back("returns about the boards' planes, rms along the ray",
                              fmt::format("{:.1f} mm", run.result.rms_mm));
    report.laser.emplace_back("what all ranges of a capture err by together, one sigma",
                              fmt::format("{:.1f} mm", 1e3 * run.result.range_bias_sigma));
  }
  for (const PixelTransfer& transfer : verdict.transfer)
    report.transfer.push_back({transfer.distance, transfer.sigma_px});
}

std::vector<std::string> findingsOf(const CalibrationRun& run) {
  std::vector<std::string> findings;
  if (run.result.laser && run.result.laser->observable) {
    std::string distances, pixels;
    for (const PixelTransfer& transfer : run.result.laser->transfer) {
      distances += fmt::format("{}{:g}", distances.empty() ? "" : " / ", transfer.distance);
      pixels += fmt::format("{}{:.2f}", pixels.empty() ? "" : " / ", transfer.sigma_px);
    }
    findings.push_back("A point that the laser measures at " + distances + " m is put " + pixels +
                       " px beside its pixel (one sigma).");
    findings.push_back("Weakest: " + run.result.laser->weakest_direction + ".");
  }
  for (std::size_t i = 0; i < run.result.cameras.size(); ++i) {
    const CameraVerdict& verdict = run.result.cameras[i];
    std::string text = fmt::format("The {} found the board in {} images; reprojection error {:.3f} px rms",
                                   nameOf(run.cameras[i]), verdict.views, verdict.rms_px);
    if (verdict.covariance_intrinsics.size() > 0)
      text += fmt::format(", focal length known to {:.2g} %",
                          100.0 * std::sqrt(verdict.covariance_intrinsics(kFx, kFx)) /
                              run.result.estimate.cameras[i].parameters[kFx]);
    findings.push_back(text + ".");
  }
  std::string counted = fmt::format("{} of {} captures count{}", run.result.used.size(),
                                    run.folder.captures.size(), run.input.laser ? " for the laser" : "");
  if (!run.without_board.empty())
    counted += fmt::format("; in {} images no board was found", run.without_board.size());
  findings.push_back(counted + ".");
  return findings;
}

}  // namespace

void writeCalibrationReport(const CalibrationRun& run, const CalibrationJob& job, const Rig& rig,
                            const std::filesystem::path& file, Existing existing) {
  CalibrationReport report;
  report.title = run.folder.name;
  report.task = taskOf(job);
  report.version = THERMOVOX_VERSION;
  report.reason = run.refused.empty() ? unobservableReason(run, job) : run.refused;
  report.determined = report.reason.empty();
  report.findings = findingsOf(run);
  report.warnings = run.result.warnings;
  report.board = boardText(run.input.board);
  report.columns = run.input.board.columns;
  for (std::size_t i = 0; i < run.cameras.size(); ++i) report.cameras.push_back(cameraOf(run, i));
  addPoses(report, run, job, rig);
  if (run.result.laser) {
    addLaser(report, run);
    report.warnings.insert(report.warnings.end(), run.result.laser->warnings.begin(),
                           run.result.laser->warnings.end());
  }
  report.by_first_guess = laserByGuess(run);
  report.captures = reportedCaptures(run);
  writeCalibrationHtml(file, report, existing);
}

}  // namespace thermovox
