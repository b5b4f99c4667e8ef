#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "apps/simulate/capture_options.hpp"
#include "apps/simulate/simulation_options.hpp"

namespace thermovox {

/// What `thermovox simulate` takes for calibration captures, instead of a mission.
struct CaptureArgs {
  simulate::CaptureOptions options;
  std::vector<double> guess_error;             ///< degrees, metres
  CLI::Option* captures = nullptr;             ///< asks for captures at all
  std::vector<CLI::Option*> of_captures;       ///< options that only captures heed
  CLI::Option* range_sigma_of_both = nullptr;  ///< whose default is another one for missions

  [[nodiscard]] bool asked() const { return captures->count() > 0; }
};

void addCaptureOptions(CLI::App& verb, CaptureArgs& args);

/// Takes what missions and captures have in common over from the mission's options, and the rest from the
/// words of the command line. Throws UsageError for what cannot be used.
void takeCaptureOptions(CaptureArgs& args, const simulate::SimulationOptions& mission);

}  // namespace thermovox
