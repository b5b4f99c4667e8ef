#include "apps/simulate_captures.hpp"

#include "apps/arguments.hpp"
#include "apps/simulate/mounting.hpp"

namespace thermovox {

void addCaptureOptions(CLI::App& verb, CaptureArgs& args) {
  simulate::CaptureOptions& options = args.options;
  const std::string only = "; of --captures";
  args.captures = verb.add_option("--captures", options.captures,
                                  "Write that many calibration captures of a heated chessboard instead of a "
                                  "mission; the truth then is OUT.truth.json (where the board stood) and "
                                  "OUT.truth_rig.yaml, the folder's own rig.yaml a first guess")
                      ->type_name("N");
  args.of_captures = {
      verb.add_option(
              "--edge-captures", options.edge_captures,
              "That many more, whose beam grazes an edge of the board, each side in turn (beam only)" + only)
          ->type_name("N"),
      verb.add_option("--spoiled", options.spoiled,
                      "How many of N have a board that moved between the images and the laser (3 to 8 cm and "
                      "degrees)" +
                          only)
          ->type_name("N"),
      verb.add_option("--contrast", options.contrast,
                      "Warm squares over cold ones, where the board is hottest [C] (default 8)" + only),
      verb.add_option("--capture-bias-sigma", options.capture_bias_sigma,
                      "Error that all ranges of a capture share, one sigma [m] (default 0)" + only),
      verb.add_option("--guess-error", args.guess_error,
                      "How far off the guessed rig has the laser, one sigma an axis: rotation [degrees] and "
                      "translation [m] (default 1.5 0.02)" +
                          only)
          ->expected(2)
          ->type_name("DEG M")};
}

void takeCaptureOptions(CaptureArgs& args, const simulate::SimulationOptions& mission) {
  simulate::CaptureOptions& options = args.options;
  options.laser = mission.laser;
  options.seed = mission.seed;
  options.netd = mission.netd;
  options.blur_px = mission.blur_px;
  if (args.range_sigma_of_both->count() > 0) options.range_sigma = mission.range_sigma;
  if (!args.guess_error.empty()) {
    options.guess = {.rotation_sigma = args.guess_error[0] * simulate::kDegree,
                     .translation_sigma = args.guess_error[1]};
  }
  try {
    options.validate();
  } catch (const ConfigError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace thermovox
