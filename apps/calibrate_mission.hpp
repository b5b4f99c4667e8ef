#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

namespace thermovox {

/// `calibrate laser --mission M --rig R [--laser N] [--refine -o RIG.yaml] [--force] [--json]`.
struct MissionRefinementArgs {
  enum class Output { table, json };

  std::filesystem::path mission;
  std::filesystem::path rig;         ///< empty: the mission's own
  std::optional<std::size_t> laser;  ///< which of the rig's, from 0; needed where it has more than one
  std::filesystem::path refined;     ///< rig to write; empty: the rig is checked only
  bool force = false;                ///< replace a rig that is there
  Output output = Output::table;
};

/// Checks the laser's place on the body, in respect of the thermal camera, on a mission, prints what was
/// found, and writes the refined rig where that is asked for: the rig as it was, where there is no good
/// reason for a change. Throws UsageError, ConfigError or DataError for input that cannot be used, and
/// UnobservableError (after the JSON, with "observable": false) where the mission shows too few edges.
void runMissionRefinement(const MissionRefinementArgs& args);

}  // namespace thermovox
