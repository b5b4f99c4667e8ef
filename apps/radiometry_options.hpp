#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "projection/radiometric_overrides.hpp"

namespace thermovox {

/// The options that replace what radiometric files say of the object, the air and the window; all but the
/// distance, which only a single image has.
void addRadiometryOptions(CLI::App& verb, RadiometricOverrides& overrides);

/// Throws UsageError for a value that cannot be.
void checkRadiometry(const RadiometricOverrides& overrides);

/// Only what was asked for, under the names of the options.
[[nodiscard]] nlohmann::ordered_json jsonOf(const RadiometricOverrides& overrides);

}  // namespace thermovox
