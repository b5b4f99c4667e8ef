#include "projection/radiometry.hpp"

#include <string>

#include "projection/error.hpp"
#include "projection/portable_math.hpp"

namespace thermovox {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string numberText(double value) {
  std::string text = std::to_string(value);
  if (text.find('.') == std::string::npos) return text;  // nan, inf
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void expect(bool holds, const char* field, double found, const char* expected) {
  if (holds) return;
  throw ConfigError(std::string("Radiometry: ") + field + " is " + numberText(found) + ", expected " +
                    expected);
}
void expectTemperature(const char* field, double celsius) {
  expect(celsius > kAbsoluteZero && celsius < 1e4, field, celsius,
         "a temperature in Celsius above -273.15 and below 10000");
}
void expectShare(const char* field, double value, double least, const char* expected) {
  expect(value >= least && value <= 1.0, field, value, expected);
}

}  // namespace

double PlanckConstants::signal(double celsius) const {
  return r1 / (r2 * (portableExp(b / (celsius - kAbsoluteZero)) - f)) - o;
}

double PlanckConstants::celsius(double signal) const {
  const double radiated = signal + o;
  const double kelvin = b / portableLog(r1 / (r2 * radiated) + f);
  return radiated > 0.0 && kelvin > 0.0 && kelvin < kHottest ? kelvin + kAbsoluteZero : kNan;
}

void RadiometricParameters::validate() const {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  expect(positive(planck.r1), "PlanckR1", planck.r1, "a number above 0");
  expect(positive(planck.r2), "PlanckR2", planck.r2, "a number above 0");
  expect(positive(planck.b), "PlanckB", planck.b, "a number above 0");
  expect(std::isfinite(planck.f), "PlanckF", planck.f, "a finite number");
  expect(std::isfinite(planck.o), "PlanckO", planck.o, "a finite number");
  expectShare("emissivity", emissivity, 0.05, "0.05 to 1");
  expect(distance >= 0.0 && std::isfinite(distance), "distance", distance, "metres, 0 or more");
  expectTemperature("reflected temperature", reflected);
  expectTemperature("atmosphere temperature", atmosphere_temperature);
  expectShare("humidity", humidity, 0.0, "a fraction from 0 to 1");
  expectTemperature("window temperature", window_temperature);
  expectShare("window transmission", window_transmission, 0.05, "0.05 to 1");
  for (const double constant :
       {atmosphere.alpha1, atmosphere.alpha2, atmosphere.beta1, atmosphere.beta2, atmosphere.x})
    expect(std::isfinite(constant), "a constant of the atmosphere", constant, "a finite number");
}

double waterInAir(const RadiometricParameters& parameters) {
  const double t = parameters.atmosphere_temperature;
  return parameters.humidity * portableExp(1.5587 + 0.06939 * t - 0.00027816 * t * t + 6.8455e-7 * t * t * t);
}

double transmission(const RadiometricParameters& parameters, double distance) {
  const AtmosphereConstants& c = parameters.atmosphere;
  const double root = std::sqrt(distance);
  const double root_water = std::sqrt(waterInAir(parameters));
  return c.x * portableExp(-root * (c.alpha1 + c.beta1 * root_water)) +
         (1.0 - c.x) * portableExp(-root * (c.alpha2 + c.beta2 * root_water));
}

SignalLine objectSignal(const RadiometricParameters& parameters) {
  const double e = parameters.emissivity;
  const double w = parameters.window_transmission;
  const double air = parameters.planck.signal(parameters.atmosphere_temperature);
  const double window = parameters.planck.signal(parameters.window_temperature);
  const double reflected = (1.0 - e) / e * parameters.planck.signal(parameters.reflected);
  if (parameters.model == AtmosphereModel::half) {
    const double tau = transmission(parameters, parameters.distance / 2.0);
    if (!(tau > 0.0)) return {kNan, kNan};
    return {1.0 / (e * tau * tau * w), -(1.0 - tau) / (e * tau) * air -
                                           (1.0 - tau) / (e * tau * tau * w) * air -
                                           (1.0 - w) / (e * tau * w) * window - reflected};
  }
  const double tau = transmission(parameters, parameters.distance);
  if (!(tau > 0.0)) return {kNan, kNan};
  return {1.0 / (e * tau * w),
          -(1.0 - tau) / (e * tau) * air - (1.0 - w) / (e * tau * w) * window - reflected};
}

double celsiusOfCounts(double counts, const RadiometricParameters& parameters) {
  return parameters.planck.celsius(objectSignal(parameters)(counts));
}

double countsOfCelsius(double celsius, const RadiometricParameters& parameters) {
  const SignalLine line = objectSignal(parameters);
  return (parameters.planck.signal(celsius) - line.offset) / line.gain;
}

}  // namespace thermovox
