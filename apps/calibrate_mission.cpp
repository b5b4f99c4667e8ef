#include "apps/calibrate_mission.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "apps/arguments.hpp"
#include "apps/mission_edges.hpp"
#include "calibration/mission_refinement.hpp"
#include "io/atomic_file.hpp"
#include "io/mission_folder.hpp"
#include "io/rig_file.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kThousand = 1e3;  // mm in a metre, ms in a second

const char* nameOf(LaserKind kind) {
  switch (kind) {
    case LaserKind::beam:
      return "beam";
    case LaserKind::scan:
      return "scan";
    case LaserKind::cloud:
      return "cloud";
  }
  return "";
}

/// Which laser is meant.
std::size_t laserOf(const MissionRefinementArgs& args, const Rig& rig, const std::string& file) {
  const std::size_t count = rig.lasers.size();
  if (count == 0) throw ConfigError(file + ": has no laser, expected one to check");
  if (!args.laser && count > 1)
    throw UsageError(
        fmt::format("--laser: not given, expected 0 to {}: {} has {} lasers", count - 1, file, count));
  const std::size_t laser = args.laser.value_or(0);
  if (laser >= count)
    throw UsageError(fmt::format("--laser: found {}, expected 0 to {}: {} has {} laser{}", laser, count - 1,
                                 file, count, count == 1 ? "" : "s"));
  return laser;
}

/// What is asked, read from the files.
struct Question {
  OpenedMission opened;
  Rig rig;
  std::size_t laser = 0;
};

/// The mission is read with its own rig, and looked at with the given one.
void checkTogether(const Question& question, const std::string& file) {
  const Rig& own = question.opened.mission.rig;
  if (!question.rig.thermal_camera) throw ConfigError(file + ": has no thermal_camera, expected one");
  if (!question.opened.frames)
    throw ConfigError(question.opened.file.string() +
                      ": has no thermal frames, expected some to check the rig by");
  if (own.lasers.size() != question.rig.lasers.size())
    throw ConfigError(fmt::format("{}: has {} lasers, expected {} as {} has", file,
                                  question.rig.lasers.size(), own.lasers.size(),
                                  question.opened.rig_file.string()));
  const LaserKind found = question.rig.lasers[question.laser].kind;
  const LaserKind expected = own.lasers[question.laser].kind;
  if (found != expected)
    throw ConfigError(fmt::format("{}: its laser {} is of kind {}, expected {} as in {}", file,
                                  question.laser, nameOf(found), nameOf(expected),
                                  question.opened.rig_file.string()));
  const Camera& camera = question.rig.thermal_camera->camera;
  const Camera& own_camera = own.thermal_camera->camera;
  if (camera.width() != own_camera.width() || camera.height() != own_camera.height())
    throw ConfigError(fmt::format("{}: its thermal camera has {} x {} pixels, expected {} x {} as in {}",
                                  file, camera.width(), camera.height(), own_camera.width(),
                                  own_camera.height(), question.opened.rig_file.string()));
}

Question questionOf(const MissionRefinementArgs& args) {
  if (!args.refined.empty()) checkOutput(args.refined, args.force ? Existing::replace : Existing::refuse);
  MissionOptions options;
  options.warn = [](const std::string& warning) { spdlog::warn("{}", warning); };
  Question question{.opened = openMission(args.mission, options), .rig = {}};
  const fs::path file = args.rig.empty() ? question.opened.rig_file : args.rig;
  question.rig = readRig(file);
  question.laser = laserOf(args, question.rig, file.string());
  checkTogether(question, file.string());
  return question;
}

std::array<double, 3> three(const EdgeChange& change, int first, double factor) {
  return {factor * change[first], factor * change[first + 1], factor * change[first + 2]};
}

Json jsonOf(const MissionRefinementArgs& args, const Question& question, const MissionRefinement& found) {
  const bool roll = question.rig.lasers[question.laser].kind != LaserKind::beam;
  return {{"mission", args.mission.string()},
          {"frames", found.frames},
          {"edges", found.edges},
          {"rms_px", found.rms_px},
          {"rms_px_refined", found.rms_px_refined},
          {"rotation_change_deg", three(found.change, 0, kDegrees)},
          {"rotation_sigma_deg", three(found.sigma, 0, kDegrees)},
          {"translation_change_mm", three(found.change, 3, kThousand)},
          {"translation_sigma_mm", three(found.sigma, 3, kThousand)},
          {"time_offset_change_ms", kThousand * found.change[6]},
          {"time_offset_sigma_ms", kThousand * found.sigma[6]},
          {"rotation_applied_deg", three(found.applied, 0, kDegrees)},
          {"translation_applied_mm", three(found.applied, 3, kThousand)},
          {"time_offset_found_ms", kThousand * found.applied[6]},
          {"gain", found.gain},
          {"gain_sigma", found.gain_sigma},
          {"lock", found.lock},
          {"undetermined", found.undetermined},
          {"observable", true},
          {"roll_observable", roll},
          {"consistent", found.consistent},
          {"refined", found.refined},
          {"warnings", found.warnings}};
}

void printLine(const char* what, const std::array<double, 3>& change, const std::array<double, 3>& sigma,
               const std::array<double, 3>& applied) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::cout << fmt::format("{:<16} {} {:+9.3f} +- {:7.3f} {:+9.3f}\n", i == 0 ? what : "", "xyz"[i],
                             change[i], sigma[i], applied[i]);
  }
}

/// What is to be done, in words.
std::string verdictOf(const MissionRefinement& found) {
  if (found.consistent)
    return fmt::format("the rig is consistent with the mission within {:.2f} px; nothing is to be changed",
                       found.rms_px);
  return fmt::format(
      "the rig is not consistent with the mission: {:.2f} px, {:.2f} px after the change ({:.0f} +- "
      "{:.0f} % of the cost of edges not fitted)",
      found.rms_px, found.rms_px_refined, 100.0 * found.gain, 100.0 * found.gain_sigma);
}

void printTable(const MissionRefinementArgs& args, const MissionRefinement& found) {
  std::cout << fmt::format("{}: {} edges in {} frames\n", args.mission.string(), found.edges, found.frames)
            << "the laser on the body    found +-   sigma   applied\n";
  printLine("rotation [deg]", three(found.change, 0, kDegrees), three(found.sigma, 0, kDegrees),
            three(found.applied, 0, kDegrees));
  printLine("translation [mm]", three(found.change, 3, kThousand), three(found.sigma, 3, kThousand),
            three(found.applied, 3, kThousand));
  std::cout << fmt::format("{:<18} {:+9.3f} +- {:7.3f} {:+9.3f}\n", "time offset [ms]",
                           kThousand * found.change[6], kThousand * found.sigma[6],
                           kThousand * found.applied[6]);
  if (!found.undetermined.empty())
    std::cout << fmt::format("not determined by this mission: {}\n", fmt::join(found.undetermined, ", "));
  std::cout << verdictOf(found) << '\n';
}

/// The time offset is the mission's, not the rig's.
void adviseOfTime(const Question& question, MissionRefinement& found) {
  if (found.applied[6] == 0.0) return;
  const double before = toSeconds(question.opened.mission.camera_time_offset);
  found.warnings.push_back(
      fmt::format("frames come {:+.0f} +- {:.0f} ms off their stamps: write camera_time_offset: "
                  "{:.4f} into {}",
                  kThousand * found.applied[6], kThousand * found.sigma[6], before + found.applied[6],
                  question.opened.file.string()));
}

void writeRefined(const MissionRefinementArgs& args, Question& question, const MissionRefinement& found) {
  Laser& laser = question.rig.lasers[question.laser];
  if (found.refined) {
    laser.T_body_laser = found.T_body_laser;
    laser.covariance_body_laser = found.covariance_body_laser;
  }
  AtomicFile file(args.refined, args.force ? Existing::replace : Existing::refuse);
  file.write(rigText(question.rig));
  file.commit();
}

MissionRefinement refinementOf(const MissionRefinementArgs& args, Question& question) {
  try {
    const EdgeScene scene = gatherEdges(question.opened, question.rig, question.laser);
    return refineOnMission(scene, question.rig.lasers[question.laser]);
  } catch (const UnobservableError& error) {
    if (args.output == MissionRefinementArgs::Output::json) {
      const Json json{{"mission", args.mission.string()}, {"observable", false}, {"reason", error.what()}};
      std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    }
    throw UnobservableError(args.mission.string() + ": " + error.what());
  }
}

}  // namespace

void runMissionRefinement(const MissionRefinementArgs& args) {
  Question question = questionOf(args);
  MissionRefinement found = refinementOf(args, question);
  adviseOfTime(question, found);
  if (!args.refined.empty()) writeRefined(args, question, found);
  for (const std::string& warning : found.warnings) spdlog::warn("{}", warning);
  if (args.output == MissionRefinementArgs::Output::json) {
    std::cout << jsonOf(args, question, found).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    return;
  }
  printTable(args, found);
  if (args.refined.empty()) return;
  std::cout << fmt::format("{} -> {}\n",
                           found.refined ? "refined rig" : "nothing was refined: the rig as it was",
                           args.refined.string());
}

}  // namespace thermovox
