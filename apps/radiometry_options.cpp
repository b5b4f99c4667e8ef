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
  const CLI::Range above_absolute_zero(-273.14, 9999.0);
  const CLI::Range share(0.05, 1.0);
  verb.add_option("--emissivity", overrides.emissivity, "Of the objects, 0.05 to 1 (default: the file's)")
      ->check(share);
  verb.add_option("--reflected", overrides.reflected,
                  "Temperature of what the objects mirror [C] (default: the file's)")
      ->check(above_absolute_zero);
  verb.add_option("--atmosphere-temperature", overrides.atmosphere_temperature,
                  "Of the air [C] (default: the file's)")
      ->check(above_absolute_zero);
  verb.add_option("--humidity", overrides.humidity, "Of the air, 0 to 1 (default: the file's)")
      ->check(CLI::Range(0.0, 1.0));
  verb.add_option("--window-temperature", overrides.window_temperature,
                  "Of a window before the lens [C] (default: the file's)")
      ->check(above_absolute_zero);
  verb.add_option("--window-transmission", overrides.window_transmission,
                  "Of a window before the lens, 0.05 to 1; 1 is none (default: the file's)")
      ->check(share);
  addChoice(verb, "--atmosphere-model", overrides.model, kModels,
            "The window at the lens, or in the middle of the air as Thermimage has it (default single)");
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
