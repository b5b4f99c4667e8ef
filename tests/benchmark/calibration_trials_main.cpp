// Monte-Carlo of the calibration against the Cramer-Rao bound: prints the table of calibration/README.md.
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "tests/benchmark/calibration_trials.hpp"

int main(int argc, char** argv) {
  using namespace thermovox::bench;
  const long runs = argc > 1 ? std::atol(argv[1]) : 100;
  const long first = argc > 2 ? std::atol(argv[2]) : 1;
  const std::string only = argc > 3 ? argv[3] : "";
  if (runs < 1 || first < 0 || argc > 4) {
    std::fprintf(stderr,
                 "usage: %s [RUNS [SEED [NAME]]]   (1 or more, default 100; the first seed, default 1;\n"
                 "       part of the name of the sets to run)\n",
                 argv[0]);
    return 2;
  }
  std::printf(
      "| set-up | solved | rotation, deg | bound | ratio | translation, mm | bound | ratio | NEES a degree "
      "of "
      "freedom | spoiled found | sound dropped | focal length, px | centre, px |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const TrialSet& set : trialSets()) {
    if (set.name.find(only) == std::string::npos) continue;
    const CalibrationSummary s =
        calibrationTrials(set, static_cast<std::uint64_t>(first), static_cast<std::size_t>(runs));
    std::printf(
        "| %s | %zu of %zu | %.3f | %.3f | %.2f | %.2f | %.2f | %.2f | %.2f | %zu of %zu | %zu | %.2f | %.2f "
        "|\n",
        set.name.c_str(), s.observable, s.trials, s.rotation_error / kDegree, s.rotation_bound / kDegree,
        s.rotation_error / s.rotation_bound, 1e3 * s.translation_error, 1e3 * s.translation_bound,
        s.translation_error / s.translation_bound, s.nees, s.spoiled_found,
        static_cast<std::size_t>(set.spoiled) * s.trials, s.sound_dropped, s.focal_error_px,
        s.centre_error_px);
    std::fflush(stdout);
  }
  return 0;
}
