#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "io/raw_thermal_image.hpp"
#include "projection/radiometric_overrides.hpp"

namespace thermovox {

/// The options that replace what radiometric files say of the object, the air and the window; all but the
/// distance, which only a single image has.
void addRadiometryOptions(CLI::App& verb, RadiometricOverrides& overrides);

/// `--distance`, of a single image.
void addDistanceOption(CLI::App& verb, RadiometricOverrides& overrides);

/// What a count of a TIFF means, as the user says it.
struct ScaleArgs {
  std::optional<double> celsius_per_count;
  double celsius_offset = kAbsoluteZero;

  [[nodiscard]] std::optional<TLinear> scale() const {
    return celsius_per_count ? std::optional(TLinear{*celsius_per_count, celsius_offset}) : std::nullopt;
  }
};
/// `--celsius-per-count` and `--celsius-offset`. `otherwise` says what holds without them.
void addScaleOptions(CLI::App& verb, ScaleArgs& args, const std::string& otherwise);

/// Throws DataError where the user has said what the counts of an image are that says it itself. `name`
/// stands for the image.
void checkScale(const std::optional<TLinear>& asked, const RawThermalImage& image, const std::string& name);

/// Throws UsageError for a value that cannot be.
void checkRadiometry(const RadiometricOverrides& overrides);

/// Only what was asked for, under the names of the options.
[[nodiscard]] nlohmann::ordered_json jsonOf(const RadiometricOverrides& overrides);

}  // namespace thermovox
