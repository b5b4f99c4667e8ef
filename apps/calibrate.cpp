#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "apps/arguments.hpp"
#include "apps/calibrate_mission.hpp"
#include "apps/calibration_job.hpp"
#include "apps/calibration_output.hpp"
#include "apps/calibration_report.hpp"
#include "apps/stage_progress.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
#include "io/rig_file.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct CalibrateArgs {
  fs::path captures;
  MissionRefinementArgs on_mission;
  CLI::Option* mission = nullptr;  ///< of the laser's task: no captures, but a mission
  bool refine = false;
  fs::path rig;
  fs::path report;  ///< empty: none
  CalibrationJob job;
  CLI::Option* laser = nullptr;  ///< which of several
  bool keep_lens = false;
  bool json = false;
  bool force = false;
};

/// The extrinsics of a rig on a mission.
void runOnMission(const CalibrateArgs& args) {
  MissionRefinementArgs mission = args.on_mission;
  if (!args.captures.empty()) throw UsageError("--mission: needs no CAPTURES, expected one or the other");
  if (!args.report.empty()) throw UsageError("--report: is of captures, expected no --mission");
  if (args.refine == args.rig.empty())
    throw UsageError(args.refine ? "--refine: expected -o RIG.yaml, the rig to write"
                                 : "-o: on a mission a rig is written with --refine only");
  if (args.refine) checkEnding(args.rig, {".yaml", ".yml"});
  mission.refined = args.rig;
  mission.force = args.force;
  mission.output = args.json ? MissionRefinementArgs::Output::json : MissionRefinementArgs::Output::table;
  if (args.laser->count() > 0) mission.laser = static_cast<std::size_t>(args.job.laser);
  runMissionRefinement(mission);
}

void runCalibrate(CalibrateArgs args) {
  if (args.mission != nullptr && args.mission->count() > 0) return runOnMission(args);
  if (args.mission != nullptr && (args.refine || !args.on_mission.rig.empty()))
    throw UsageError("--rig and --refine: are of --mission, expected it too");
  if (args.captures.empty() || args.rig.empty())
    throw UsageError(args.captures.empty() ? "CAPTURES: expected a folder of captures (or --mission)"
                                           : "-o: expected the rig to write (.yaml)");
  if (args.keep_lens) args.job.lens = CameraGuess::Lens::keep;
  checkEnding(args.rig, {".yaml", ".yml"});
  const Existing existing = args.force ? Existing::replace : Existing::refuse;
  checkOutput(args.rig, existing);
  if (!args.report.empty()) {
    checkEnding(args.report, {".html"});
    checkOutput(args.report, existing);
  }
  CalibrationRun run;
  {
    StageProgress progress;
    args.job.progress = [&](const std::string& stage, double done) { progress.at(stage, done); };
    run = readCalibration(args.captures, args.job);
    try {
      calibrate(run, args.job);
    } catch (const UnobservableError&) {
      if (!args.report.empty()) writeCalibrationReport(run, args.job, run.folder.rig, args.report, existing);
      throw;
    }
  }
  const Rig rig = calibratedRig(run, args.job);
  const std::string reason = unobservableReason(run, args.job);
  if (args.json) std::cout << calibrationJson(run, args.job, rig) << std::flush;
  if (!args.report.empty()) writeCalibrationReport(run, args.job, rig, args.report, existing);
  if (!reason.empty()) throw UnobservableError(args.captures.string() + ": " + reason);
  writeRig(args.rig, rig);
  for (const std::string& warning : run.result.warnings) spdlog::warn("{}", warning);
  if (run.result.laser) {
    for (const std::string& warning : run.result.laser->warnings) spdlog::warn("{}", warning);
  }
  if (!args.json)
    std::cout << calibrationTable(run, args.job, rig) << "rig     " << args.rig.string() << '\n';
}

const std::map<std::string, CalibrationCamera> kCameras{{"thermal", CalibrationCamera::thermal},
                                                        {"visible", CalibrationCamera::visible}};

/// What the three tasks have in common.
void addCommon(CLI::App& verb, CalibrateArgs& args) {
  verb.add_option("CAPTURES", args.captures,
                  "Folder of captures (captures.yaml), with the first guess of the rig");
  verb.add_option("-o,--output", args.rig, "Rig to write (.yaml), with covariances");
  verb.add_option("--report", args.report,
                  "Also write a report (.html) with pictures of every capture; also where exit code is 3");
  verb.add_flag("--force", args.force, "Replace files that are there");
  verb.add_flag("--json", args.json, "Print one JSON object");
  addThreadsOption(verb, args.job.threads);
}

/// Instead of captures.
void addMissionOptions(CLI::App& verb, CalibrateArgs& args) {
  args.mission = verb.add_option("--mission", args.on_mission.mission,
                                 "Instead of captures a mission: checks the laser's place in respect of the "
                                 "thermal camera by edges of temperature and of depth");
  verb.add_option("--rig", args.on_mission.rig, "Rig to check, of --mission (default: the mission's own)");
  verb.add_flag(
      "--refine", args.refine,
      "With --mission and -o: write the rig refined, or as it was where nothing speaks for a change");
}

void addTask(CLI::App& calibrate, const std::string& name, CalibrationTask task, const std::string& help) {
  auto args = std::make_shared<CalibrateArgs>();
  args->job.task = task;
  CLI::App* verb = calibrate.add_subcommand(name, help);
  addCommon(*verb, *args);
  if (task != CalibrationTask::stereo)
    addChoice(*verb, "--camera", args->job.camera, kCameras, "Which camera (default thermal)");
  if (task == CalibrationTask::laser) {
    args->laser = verb->add_option("--laser", args->job.laser, "Which of the rig's lasers, from 0")
                      ->capture_default_str()
                      ->check(CLI::NonNegativeNumber);
    verb->add_flag("--keep-lens", args->keep_lens,
                   "Take the cameras' intrinsics from the rig as exact instead of estimating them");
    addMissionOptions(*verb, *args);
  }
  verb->callback([args] { runCalibrate(*args); });
}

}  // namespace

void addCalibrate(CLI::App& app) {
  CLI::App* calibrate = app.add_subcommand(
      "calibrate",
      "Calibrate a rig from captures of a heated chessboard: lenses, cameras to each other, laser to "
      "cameras. "
      "Tilt the board by 30 to 60 degrees in all directions, at near and far distances, 20 captures or more "
      "(40 for a beam). Exit code 3 says that the captures cannot determine the answer, and why.");
  calibrate->require_subcommand(1);
  addTask(*calibrate, "camera", CalibrationTask::camera, "Intrinsics and distortion of one camera.");
  addTask(*calibrate, "stereo", CalibrationTask::stereo,
          "Both cameras' intrinsics, and the visible camera's pose against the thermal one's.");
  addTask(*calibrate, "laser", CalibrationTask::laser,
          "The laser's pose on the body, together with the lenses and the visible camera where they help.");
}

}  // namespace thermovox
