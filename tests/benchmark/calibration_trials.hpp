#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "projection/rig.hpp"

namespace thermovox::bench {

/// A way to calibrate, tried again and again with other boards and other noise.
struct TrialSet {
  std::string name;
  LaserKind laser = LaserKind::cloud;
  int captures = 20;
  int edge_captures = 0;              ///< of a beam
  int spoiled = 0;                    ///< of the captures
  double capture_bias_sigma = 0.005;  ///< of the ranges of a capture, metres
  double corner_sigma_px = 0.1;       ///< of the thermal camera
  enum class Cameras { thermal, both };
  Cameras cameras = Cameras::thermal;
  enum class Edges { used, unknown };
  Edges edges = Edges::unknown;  ///< unknown: nobody says how large the plate is
};

/// One of them.
struct CalibrationTrial {
  bool observable = false;
  double rotation_error = 0.0, rotation_bound = 0.0;        ///< rad: norm, root of the bound's trace
  double translation_error = 0.0, translation_bound = 0.0;  ///< metres, likewise
  double nees = 0.0;                                        ///< a degree of freedom
  double focal_error_px = 0.0, centre_error_px = 0.0;       ///< of the thermal camera, largest of two
  std::size_t spoiled_found = 0, sound_dropped = 0;         ///< captures
};

[[nodiscard]] std::vector<TrialSet> trialSets();
[[nodiscard]] CalibrationTrial calibrationTrial(const TrialSet& set, std::uint64_t seed);

/// All of some trials that were observable, as root mean squares, and means.
struct CalibrationSummary {
  std::size_t trials = 0, observable = 0;
  double rotation_error = 0.0, rotation_bound = 0.0;
  double translation_error = 0.0, translation_bound = 0.0;
  double nees = 0.0;
  double focal_error_px = 0.0, centre_error_px = 0.0;
  std::size_t spoiled_found = 0, sound_dropped = 0;
};

[[nodiscard]] CalibrationSummary calibrationTrials(const TrialSet& set, std::uint64_t first_seed,
                                                   std::size_t runs);

}  // namespace thermovox::bench
