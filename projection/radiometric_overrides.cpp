#include "projection/radiometric_overrides.hpp"

namespace thermovox {

void RadiometricOverrides::validate() const {
  RadiometricParameters any_camera;
  any_camera.planck = {1.0, 1.0, 1.0, 1.0, 0.0};
  applyTo(any_camera).validate();
}

RadiometricOverrides RadiometricOverrides::orElse(const RadiometricOverrides& others) const {
  const auto first = [](const auto& own, const auto& other) { return own ? own : other; };
  return {first(emissivity, others.emissivity),
          first(distance, others.distance),
          first(reflected, others.reflected),
          first(atmosphere_temperature, others.atmosphere_temperature),
          first(humidity, others.humidity),
          first(window_temperature, others.window_temperature),
          first(window_transmission, others.window_transmission),
          first(model, others.model)};
}

RadiometricParameters RadiometricOverrides::applyTo(RadiometricParameters parameters) const {
  parameters.emissivity = emissivity.value_or(parameters.emissivity);
  parameters.distance = distance.value_or(parameters.distance);
  parameters.reflected = reflected.value_or(parameters.reflected);
  parameters.atmosphere_temperature = atmosphere_temperature.value_or(parameters.atmosphere_temperature);
  parameters.humidity = humidity.value_or(parameters.humidity);
  parameters.window_temperature = window_temperature.value_or(parameters.window_temperature);
  parameters.window_transmission = window_transmission.value_or(parameters.window_transmission);
  parameters.model = model.value_or(parameters.model);
  return parameters;
}

}  // namespace thermovox
