#pragma once

#include <filesystem>
#include <string>

#include "projection/rig.hpp"

namespace thermovox {

/// Reads a rig.yaml: the thermal and the visible camera (each optional), the lasers (none, one or a list),
/// how they are mounted and what is known of their errors. Quaternions off norm one by at most 1 % are
/// normalised. `K_matlab`, nine numbers row by row, replaces fx fy cx cy: the transposed matrix [fx 0 0; 0 fy
/// 0; cx cy 1], its cx and cy in pixels counted from zero like everywhere else. celsius_per_count and
/// celsius_offset come together or not at all. Throws DataError when the file cannot be read and ConfigError,
/// naming file and key, for what is missing, unknown, not a finite number or impossible.
[[nodiscard]] Rig readRig(const std::filesystem::path& file);

/// The same from the text of such a file; `name` stands for it in messages.
[[nodiscard]] Rig parseRig(const std::string& text, const std::string& name);

/// Writes a rig so that readRig gives the very same numbers back. The file is replaced as a whole or not at
/// all.
void writeRig(const std::filesystem::path& file, const Rig& rig);

/// The text that writeRig writes.
[[nodiscard]] std::string rigText(const Rig& rig);

}  // namespace thermovox
