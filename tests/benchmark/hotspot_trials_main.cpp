// Monte-Carlo of the error bars of hot spots: prints the table of mapping/README.md.
#include <cstdio>
#include <cstdlib>

#include "tests/benchmark/hotspot_trials.hpp"

int main(int argc, char** argv) {
  using namespace thermovox::bench;
  const long runs = argc > 1 ? std::atol(argv[1]) : 300;
  const long first = argc > 2 ? std::atol(argv[2]) : 1;
  if (runs < 1 || first < 0 || argc > 3) {
    std::fprintf(stderr, "usage: %s [RUNS [SEED]]   (1 or more, default 300; the first seed, default 1)\n",
                 argv[0]);
    return 2;
  }
  std::printf(
      "| declared errors | joints found | in the 95 %% ellipsoid | NEES a degree of freedom | mean error | "
      "peak within 1.96 sigmas | NEES of the peak | mean error of the peak |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const ErrorSet& set : errorSets()) {
    const TrialSummary s =
        summaryOf(hotspotTrials(set, static_cast<std::uint64_t>(first), static_cast<std::size_t>(runs)));
    std::printf("| %s | %zu of %zu | %.1f %% | %.2f | %.1f mm | %.1f %% | %.2f | %.2f C |\n",
                set.name.c_str(), s.found, s.joints, 100 * s.position_coverage, s.position_nees,
                1000 * s.mean_distance, 100 * s.peak_coverage, s.peak_nees, s.mean_peak_error);
    std::fflush(stdout);
  }
  return 0;
}
