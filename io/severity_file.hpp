#pragma once

#include <filesystem>
#include <string>

#include "mapping/severity.hpp"

namespace thermovox {

/// Reads a table of severities (YAML, see io/README.md). Throws DataError when the file cannot be read and
/// ConfigError, naming file and key, for what is missing, unknown, not a finite number, not ascending, or not
/// printable.
[[nodiscard]] SeverityTable readSeverity(const std::filesystem::path& file);

/// The same from the text of such a file; `name` stands for it in messages.
[[nodiscard]] SeverityTable parseSeverity(const std::string& text, const std::string& name);

}  // namespace thermovox
