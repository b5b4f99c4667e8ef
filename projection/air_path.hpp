#pragma once

#include <cmath>
#include <limits>

#include "projection/portable_math.hpp"
#include "projection/radiometry.hpp"

namespace thermovox {

/// The air between a camera and the points it sees, each at its own distance. An image is decoded with
/// distance 0, as if there were no air; what `distance` metres of it do to an object's signal is a straight
/// line, so that a temperature t0 read in that image becomes
///   S(t) = a S(t0) + b;   single: a = 1 / tau(d),     b = (a - 1) (Cr - Sair / e)
///                         half:   a = 1 / tau(d/2)^2, b = (a - q) (Cw - Sair / (e W)) + (a - 1) Cr
///                                                         - (q - 1) Sair / e, q = 1 / tau(d/2)
/// with Cr = (1 - e) / e S(reflected), Cw = (1 - W) / (e W) S(window): objectSignal() at d after its inverse
/// at 0.
class AirPath {
 public:
  struct Corrected {
    double celsius;  ///< NaN where no temperature gives the signal
    double slope;    ///< d celsius / d the temperature that was read
  };

  /// The parameters' own distance has no part in it. Throws ConfigError as validate() does.
  explicit AirPath(const RadiometricParameters& parameters);

  [[nodiscard]] const RadiometricParameters& parameters() const { return parameters_; }
  /// `celsius` as read in the image, `distance` from the camera to the point, metres. The same bits on every
  /// processor, one by one or in a loop.
  [[nodiscard]] THERMOVOX_INLINE_LOOP Corrected at(double celsius, double distance) const;

 private:
  RadiometricParameters parameters_;
  double decay1_, decay2_;  ///< alpha + beta sqrt(water), of half the distance in the half model
  double over_window_;      ///< Cw - Sair / (e W); 0 in the single model
  double over_air_;         ///< Cr, less Sair / e in the single model
  double over_half_;        ///< -Sair / e; 0 in the single model
  double single_, half_;    ///< 1 for the model in use, 0 for the other: a choice would stop the vectors
};

THERMOVOX_INLINE_LOOP AirPath::Corrected AirPath::at(double celsius, double distance) const {
  const PlanckConstants& planck = parameters_.planck;
  const double root = std::sqrt(distance);
  const double x = parameters_.atmosphere.x;
  const double tau = x * portableExp(-root * decay1_) + (1.0 - x) * portableExp(-root * decay2_);
  const double q = 1.0 / tau;
  const double a = single_ * q + half_ * (q * q);
  const double b = (a - q) * over_window_ + (a - 1.0) * over_air_ + (q - 1.0) * over_half_;

  // What a black body of temperature T radiates, in counts: p = r1 / (r2 (E - f)), E = exp(b / T), T in
  // kelvin.
  const double kelvin0 = celsius - kAbsoluteZero;
  const double power0 = portableExp(planck.b / kelvin0);
  const double radiated0 = planck.r1 / (planck.r2 * (power0 - planck.f));
  const double radiated = a * (radiated0 - planck.o) + b + planck.o;
  const double power = planck.r1 / (planck.r2 * radiated) + planck.f;
  const double kelvin = planck.b / portableLog(power);
  const bool counts = tau > 0.0 && radiated > 0.0 && kelvin > 0.0 && kelvin < PlanckConstants::kHottest;
  // dp / dT = r2 / r1 p^2 E b / T^2
  const double ratio = radiated0 / radiated;
  const double kelvins = kelvin / kelvin0;
  const double slope = a * (power0 / power) * (kelvins * kelvins) * (ratio * ratio);
  return {counts ? kelvin + kAbsoluteZero : std::numeric_limits<double>::quiet_NaN(), slope};
}

}  // namespace thermovox
