#pragma once

#include <filesystem>
#include <string>

#include "mapping/assets.hpp"

namespace thermovox {

/// Reads the assets of a plant (YAML, see io/README.md). Throws DataError when the file cannot be read and
/// ConfigError, naming file and key, for what is missing, unknown, not a finite number, impossible or not
/// printable.
[[nodiscard]] Assets readAssets(const std::filesystem::path& file);

/// The same from the text of such a file; `name` stands for it in messages.
[[nodiscard]] Assets parseAssets(const std::string& text, const std::string& name);

}  // namespace thermovox
