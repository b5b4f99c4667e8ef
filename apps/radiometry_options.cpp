#include "apps/radiometry_options.hpp"

#include <map>
#include <string>

#include "apps/arguments.hpp"
#include "projection/kind_names.hpp"

namespace thermovox {
namespace {

const std::map<std::string, AtmosphereModel> kModels{
    {nameOf(AtmosphereModel::single), AtmosphereModel::single},
    {nameOf(AtmosphereModel::half), AtmosphereModel::half}};

}  // namespace

void addRadiometryOptions(CLI::App& verb, RadiometricOverrides& overrides) {
  verb.add_option("--emissivity", overrides.emissivity,
                  "Emissivity of the objects, 0.05 to 1, instead of what radiometric files say");
  verb.add_option("--reflected", overrides.reflected, "Temperature that the objects mirror [C], likewise");
  verb.add_option("--atmosphere-temperature", overrides.atmosphere_temperature,
                  "Temperature of the air [C], likewise");
  verb.add_option("--humidity", overrides.humidity, "Relative humidity of the air, 0 to 1, likewise");
  verb.add_option("--window-temperature", overrides.window_temperature,
                  "Temperature of a window before the lens [C], likewise");
  verb.add_option("--window-transmission", overrides.window_transmission,
                  "Transmission of that window, 0.05 to 1 (1: no window), likewise");
  addChoice(
      verb, "--atmosphere-model", overrides.model, kModels,
      "How the air attenuates: single (one stretch, as the cameras' manuals have it) or half (two halves "
      "about a window, as Thermimage has it) (default single)");
}

void addDistanceOption(CLI::App& verb, RadiometricOverrides& overrides) {
  verb.add_option("--distance", overrides.distance, "From the object to the camera [m], likewise");
}

void addScaleOptions(CLI::App& verb, ScaleArgs& args, const std::string& otherwise) {
  CLI::Option* per_count =
      verb.add_option("--celsius-per-count", args.celsius_per_count,
                      "Of a TIFF of counts: degrees a count [C] (default: " + otherwise + ")")
          ->check(CLI::PositiveNumber)
          ->check(isFinite());
  verb.add_option("--celsius-offset", args.celsius_offset, "Temperature of count 0 [C]")
      ->check(isFinite())
      ->capture_default_str()
      ->needs(per_count);
}

void checkScale(const std::optional<TLinear>& asked, const RawThermalImage& image, const std::string& name) {
  if (!asked || image.rule_source == RuleSource::option) return;
  throw DataError(name +
                  ": its pixels have a meaning of their own, expected a TIFF of counts for "
                  "--celsius-per-count");
}

void checkRadiometry(const RadiometricOverrides& overrides) {
  try {
    overrides.validate();
  } catch (const ConfigError& error) {
    throw UsageError(error.what());
  }
}

nlohmann::ordered_json jsonOf(const RadiometricOverrides& overrides) {
  nlohmann::ordered_json json;
  const auto put = [&](const char* name, const std::optional<double>& value) {
    if (value) json[name] = *value;
  };
  put("emissivity", overrides.emissivity);
  put("reflected", overrides.reflected);
  put("atmosphere_temperature", overrides.atmosphere_temperature);
  put("humidity", overrides.humidity);
  put("window_temperature", overrides.window_temperature);
  put("window_transmission", overrides.window_transmission);
  if (overrides.model) json["atmosphere_model"] = nameOf(*overrides.model);
  return json;
}

}  // namespace thermovox
