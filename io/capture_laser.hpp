#pragma once

#include <vector>

#include "io/capture_folder.hpp"
#include "projection/laser/laser_return.hpp"

namespace thermovox {

/// All that a laser recorded of one capture's still board: a range or a scan a row (beam, scan), or one PCD
/// or PLY file, by the laser's kind. The readings have the stamps of their rows, that of a cloud is zero.
/// Empty where the capture has no laser file. Throws DataError naming the file, also when nothing in it is a
/// return within the laser's limits.
[[nodiscard]] std::vector<Reading> readCaptureLaser(const CaptureFiles& capture, const Laser& laser);

}  // namespace thermovox
