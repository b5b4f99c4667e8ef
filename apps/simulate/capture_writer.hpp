#pragma once

#include <filesystem>

#include "apps/simulate/capture_options.hpp"

namespace thermovox::simulate {

/// Where the true rig of the captures `out` lies: OUT.truth_rig.yaml beside it. Where each board stood is
/// told by truthPath(out).
[[nodiscard]] std::filesystem::path truthRigPath(const std::filesystem::path& out);

/// Writes the folder `out` of calibration captures, with a first guess of the rig, and the truth beside it.
/// Same options and name, same bytes, whatever the number of threads. All of it appears, or nothing. Throws
/// ConfigError for an option that cannot be used and DataError where out or a truth exists already or cannot
/// be written.
void simulateCaptures(const CaptureOptions& options, const std::filesystem::path& out);

}  // namespace thermovox::simulate
