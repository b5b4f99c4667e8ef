#pragma once

#include <optional>

#include "projection/radiometry.hpp"

namespace thermovox {

/// What a user knows better than the file: each value that is there takes the place of the file's own. Units
/// as in RadiometricParameters.
struct RadiometricOverrides {
  std::optional<double> emissivity;
  std::optional<double> distance;
  std::optional<double> reflected;
  std::optional<double> atmosphere_temperature;
  std::optional<double> humidity;
  std::optional<double> window_temperature;
  std::optional<double> window_transmission;
  std::optional<AtmosphereModel> model;

  bool operator==(const RadiometricOverrides&) const = default;
  [[nodiscard]] bool any() const { return *this != RadiometricOverrides(); }
  /// Throws ConfigError naming the field, what was found and what was expected.
  void validate() const;
  /// These values; where there is none, that of `others`.
  [[nodiscard]] RadiometricOverrides orElse(const RadiometricOverrides& others) const;
  /// The parameters with these values in them.
  [[nodiscard]] RadiometricParameters applyTo(RadiometricParameters parameters) const;
};

}  // namespace thermovox
