#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "apps/arguments.hpp"
#include "apps/simulate/capture_writer.hpp"
#include "apps/simulate/mission_writer.hpp"
#include "apps/simulate_captures.hpp"
#include "apps/verbs.hpp"
#include "io/atomic_file.hpp"
#include "io/folders.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

struct SimulateArgs {
  simulate::SimulationOptions options;
  fs::path out;
  bool force = false;
  std::vector<double> extrinsic_sigma;   ///< degrees, metres
  std::vector<double> pose_sigma;        ///< degrees, metres
  std::vector<CLI::Option*> of_rjpeg;    ///< options that only radiometric frames heed
  std::vector<CLI::Option*> of_mission;  ///< options that captures would not heed
  CaptureArgs captures;
};

const std::map<std::string, LaserKind> kLaserKinds{
    {"beam", LaserKind::beam}, {"scan", LaserKind::scan}, {"cloud", LaserKind::cloud}};
const std::map<std::string, LensModel> kLensModels{{"pinhole", LensModel::pinhole},
                                                   {"brown_conrady", LensModel::brown_conrady},
                                                   {"kannala_brandt", LensModel::kannala_brandt}};

const std::map<std::string, simulate::FrameFormat> kFrameFormats{{"rjpeg", simulate::FrameFormat::rjpeg},
                                                                 {"tiff", simulate::FrameFormat::tiff}};

/// Puts an old result out of the way while a new one is made: back if that fails, gone if it succeeds.
class SetAside {
 public:
  explicit SetAside(const fs::path& path) : path_(path), aside_(path.string() + ".old") {
    if (!fs::exists(path_)) return;
    fs::remove_all(aside_);
    fs::rename(path_, aside_);
    moved_ = true;
  }
  ~SetAside() {
    std::error_code ignored;
    if (moved_ && !fs::exists(path_, ignored)) fs::rename(aside_, path_, ignored);
  }
  SetAside(const SetAside&) = delete;
  SetAside& operator=(const SetAside&) = delete;

  void discard() const {
    if (moved_) fs::remove_all(aside_);
  }

 private:
  fs::path path_;
  fs::path aside_;
  bool moved_ = false;
};

/// What is made, and what of it lies where.
struct Product {
  const char* kind;     ///< in messages
  const char* told_by;  ///< the file that every folder of this kind has
  std::vector<fs::path> paths;
  std::function<void()> make;
};

Product missionOf(const SimulateArgs& args) {
  return {"mission", "mission.yaml", {withoutSlash(args.out), simulate::truthPath(args.out)}, [&args] {
            simulate::simulateMission(args.options, args.out);
          }};
}

Product capturesOf(const SimulateArgs& args) {
  return {"captures",
          "captures.yaml",
          {withoutSlash(args.out), simulate::truthPath(args.out), simulate::truthRigPath(args.out)},
          [&args] { simulate::simulateCaptures(args.captures.options, args.out); }};
}

/// Only a folder of the same kind is replaced, and what lies beside it.
void replace(const Product& product) {
  const fs::path& out = product.paths.front();
  const bool empty = fs::is_directory(out) && fs::is_empty(out);
  if (fs::exists(out) && !empty && !fs::exists(out / product.told_by)) {
    throw DataError(out.string() + ": exists and is no " + product.kind + " (no " + product.told_by +
                    " in it), expected a name that --force may replace");
  }
  std::vector<std::unique_ptr<SetAside>> old;
  for (const fs::path& path : product.paths) old.push_back(std::make_unique<SetAside>(path));
  product.make();
  for (const auto& path : old) path->discard();
}

/// One sigma an axis, the axes independent of each other.
Matrix6d isotropic(double rotation, double translation) {
  Vector6d variances;
  variances.head<3>().setConstant(rotation * rotation);
  variances.tail<3>().setConstant(translation * translation);
  return variances.asDiagonal();
}

void takeErrors(SimulateArgs& args) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  simulate::DeclaredErrors& errors = args.options.errors;
  for (const std::vector<double>* sigmas : {&args.extrinsic_sigma, &args.pose_sigma}) {
    for (const double sigma : *sigmas) {
      if (!(sigma >= 0.0)) throw UsageError("simulate: found a negative sigma, expected 0 or more");
    }
  }
  if (!args.extrinsic_sigma.empty()) {
    errors.covariance_body_laser = isotropic(args.extrinsic_sigma[0] * kDegree, args.extrinsic_sigma[1]);
  }
  if (!args.pose_sigma.empty()) {
    errors.pose_rotation_sigma = args.pose_sigma[0] * kDegree;
    errors.pose_translation_sigma = args.pose_sigma[1];
  }
}

void checkUsage(SimulateArgs& args) {
  if (args.captures.asked()) {
    refuseOptions(args.of_mission,
                  "captures are taken standing still and without declared errors, expected "
                  "it without --captures");
    takeCaptureOptions(args.captures, args.options);
    return;
  }
  refuseOptions(args.captures.of_captures, "a mission has no such thing, expected it with --captures N");
  if (args.options.frames != simulate::FrameFormat::rjpeg)
    refuseOptions(args.of_rjpeg,
                  "--frames tiff stores temperatures as if there were no air, expected "
                  "--frames rjpeg");
  try {
    args.options.validate();
  } catch (const ConfigError& error) {
    throw UsageError(error.what());
  }
}

/// What is where now, a line each.
void tell(const Product& product, const fs::path& out) {
  const std::array<std::string, 3> roles{product.kind, "truth", "rig"};
  for (std::size_t i = 0; i < product.paths.size(); ++i) {
    const fs::path& path = i == 0 ? out : product.paths[i];
    std::cout << fmt::format("{:<{}} {}\n", roles[i], roles[0].size(), path.string());
  }
}

void runSimulate(SimulateArgs& args) {
  takeErrors(args);
  checkUsage(args);
  checkFolderOf(withoutSlash(args.out));
  const Product product = args.captures.asked() ? capturesOf(args) : missionOf(args);
  if (args.force) {
    replace(product);
  } else {
    product.make();
  }
  tell(product, args.out);
}

/// How the hall is flown.
void addFlight(CLI::App& verb, SimulateArgs& args) {
  simulate::SimulationOptions& options = args.options;
  const auto of_mission = [&args](CLI::Option* option) { args.of_mission.push_back(option); };
  of_mission(verb.add_option("--hall-seed", options.hall_seed,
                             "Of the hall alone, to fly the same hall again (default: --seed)"));
  of_mission(verb.add_option("--duration", options.duration, "Seconds of measuring")->capture_default_str());
  of_mission(addChoice(verb, "--lens", options.lens, kLensModels,
                       "Lens model of the thermal camera (default brown_conrady)"));
  of_mission(
      verb.add_option("--frame-rate", options.frame_rate, "Thermal frames a second")->capture_default_str());
  of_mission(addChoice(
      verb, "--frames", options.frames, kFrameFormats,
      "What the thermal camera stores: rjpeg (radiometric JPEGs, seen through the hall's air) or tiff "
      "(temperatures, as if there were no air) (default tiff)"));
  args.of_rjpeg = {verb.add_option("--air", options.air, "Temperature of the air, of --frames rjpeg [C]")
                       ->capture_default_str(),
                   verb.add_option("--humidity", options.humidity, "Its relative humidity, 0 to 1, likewise")
                       ->capture_default_str()};
  for (CLI::Option* option : args.of_rjpeg) of_mission(option);
  of_mission(verb.add_flag_callback(
      "--visible", [&options] { options.visible = simulate::SimulationOptions::VisibleCamera::present; },
      "A visible camera beside the thermal one, 640 x 480: its pictures and its place in the rig"));
}

/// What the mission declares of its errors, and is made with.
void addErrors(CLI::App& verb, SimulateArgs& args) {
  simulate::DeclaredErrors& errors = args.options.errors;
  const auto of_mission = [&args](CLI::Option* option) { args.of_mission.push_back(option); };
  const std::string drawn = "; declared in the files, and drawn once: OUT.truth.json says what";
  of_mission(verb.add_option("--extrinsic-sigma", args.extrinsic_sigma,
                             "Error of the laser's place on the body, one sigma an axis: rotation [degrees] "
                             "and translation [m]" +
                                 drawn)
                 ->expected(2)
                 ->type_name("DEG M"));
  of_mission(verb.add_option("--pose-sigma", args.pose_sigma,
                             "Error that all poses share, likewise: rotation [degrees] and translation [m]")
                 ->expected(2)
                 ->type_name("DEG M"));
  of_mission(verb.add_option("--range-bias-sigma", errors.range_bias_sigma,
                             "Error that all ranges share, one sigma, likewise [m]")
                 ->capture_default_str());
  of_mission(verb.add_option("--bias-sigma", errors.camera_bias_sigma,
                             "Error that all temperatures share, one sigma, likewise [C]")
                 ->capture_default_str());
}

}  // namespace

void addSimulate(CLI::App& app) {
  auto args = std::make_shared<SimulateArgs>();
  simulate::SimulationOptions& options = args->options;
  CLI::App* verb = app.add_subcommand(
      "simulate",
      "Fly a synthetic converter hall and write the mission, with its truth beside it (OUT.truth.json); or, "
      "with --captures, hold a heated chessboard before a rig and write captures to calibrate it by.");
  verb->add_option("OUT", args->out, "Folder to write")->required();
  addChoice(*verb, "--laser", options.laser, kLaserKinds, "Kind of laser: beam (1D), scan (2D) or cloud (3D)")
      ->required();
  verb->add_option("--seed", options.seed,
                   "Of all that is drawn, such as hall, flight and noise: same seed, same bytes")
      ->capture_default_str();
  verb->add_option("--netd", options.netd, "Noise of a thermal pixel, one sigma [C]")->capture_default_str();
  verb->add_option("--blur", options.blur_px, "Optics and pixel together, one sigma [px]")
      ->capture_default_str();
  args->captures.range_sigma_of_both = verb->add_option(
      "--range-sigma", options.range_sigma, "Range noise, one sigma [m] (default 0.01; of captures 0.008)");
  addFlight(*verb, *args);
  addErrors(*verb, *args);
  addCaptureOptions(*verb, args->captures);
  verb->add_flag("--force", args->force, "Replace a mission, or captures, that are there");
  verb->callback([args] { runSimulate(*args); });
}

}  // namespace thermovox
