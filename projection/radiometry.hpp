#pragma once

#include <cmath>
#include <limits>

namespace thermovox {

/// 0 K in Celsius.
inline constexpr double kAbsoluteZero = -273.15;

/// Linear camera: Celsius = counts * celsius_per_count + celsius_offset. A FLIR Duo R stores hundredths of a
/// kelvin: 31730 counts are 44.15 C.
struct TLinear {
  double celsius_per_count = 0.01;
  double celsius_offset = kAbsoluteZero;

  /// Celsius of a count; NaN for what no surface can have (absolute zero and below, as an empty pixel of
  /// count 0 would read).
  [[nodiscard]] float celsius(double counts) const {
    const double value = counts * celsius_per_count + celsius_offset;
    return value > kAbsoluteZero + 1e-6 ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
  }
};

/// How one camera answers a black body, fitted by its maker:
///   signal(T) = r1 / (r2 (exp(b / T) - f)) - o, T in kelvin, the signal in counts.
/// A camera's own constants have no useful default.
struct PlanckConstants {
  double r1 = 0.0;
  double r2 = 0.0;
  double b = 0.0;  ///< kelvin
  double f = 0.0;
  double o = 0.0;  ///< counts

  /// Kelvin; constants of damaged files give any heat, or one without end.
  static constexpr double kHottest = 1e6;

  bool operator==(const PlanckConstants&) const = default;
  [[nodiscard]] double signal(double celsius) const;
  /// NaN where no temperature gives the signal.
  [[nodiscard]] double celsius(double signal) const;
};

/// Of transmission(); the defaults are those that nearly every camera stores.
struct AtmosphereConstants {
  double alpha1 = 0.006569;
  double alpha2 = 0.01262;
  double beta1 = -0.002276;
  double beta2 = -0.00667;
  double x = 1.9;

  bool operator==(const AtmosphereConstants&) const = default;
};

/// Where the window stands in the air. single: at the lens, all air before it (the manuals of the cameras).
/// half: in the middle, half of the distance on each side (Thermimage and what follows it).
enum class AtmosphereModel { single, half };

/// What a radiometric camera's counts mean. Temperatures in Celsius.
struct RadiometricParameters {
  PlanckConstants planck;
  double emissivity = 0.95;              ///< of the object, 0.05 to 1
  double distance = 1.0;                 ///< from the object to the lens, metres
  double reflected = 20.0;               ///< what the object mirrors
  double atmosphere_temperature = 20.0;  ///< of the air
  double humidity = 0.5;                 ///< of the air, relative, 0 to 1
  double window_temperature = 20.0;      ///< of a window before the lens
  double window_transmission = 1.0;      ///< 0.05 to 1; 1 is no window
  AtmosphereConstants atmosphere;
  AtmosphereModel model = AtmosphereModel::single;

  bool operator==(const RadiometricParameters&) const = default;
  /// Throws ConfigError naming the field, what was found and what was expected.
  void validate() const;
};

/// Water in the parameters' air, grams a cubic metre, t in Celsius:
///   w = humidity exp(1.5587 + 0.06939 t - 0.00027816 t^2 + 6.8455e-7 t^3)
[[nodiscard]] double waterInAir(const RadiometricParameters& parameters);

/// The share of an object's radiation that `distance` metres of the parameters' air let through:
///   tau = x exp(-sqrt(d) (alpha1 + beta1 sqrt(w))) + (1 - x) exp(-sqrt(d) (alpha2 + beta2 sqrt(w)))
/// with w = waterInAir(), the model of FLIR's cameras. Far beyond the distances it was
/// fitted for it falls below 0 in hot, humid air: then no temperature follows from a count.
[[nodiscard]] double transmission(const RadiometricParameters& parameters, double distance);

/// A straight line from one signal to another, both in counts.
struct SignalLine {
  double gain = 1.0;
  double offset = 0.0;

  [[nodiscard]] double operator()(double signal) const { return gain * signal + offset; }
};

/// From what the camera counts to what the object alone would give as a black body, at parameters.distance:
///   counts = W (e tau S(object) + (1 - e) tau S(reflected) + (1 - tau) S(air)) + (1 - W) S(window)
/// for the single model; the half model has the window between two halves of the air. NaN where the air lets
/// nothing through.
[[nodiscard]] SignalLine objectSignal(const RadiometricParameters& parameters);

/// The object's temperature, C; NaN where no temperature gives the counts.
[[nodiscard]] double celsiusOfCounts(double counts, const RadiometricParameters& parameters);
/// What the camera counts before an object of that temperature, not rounded.
[[nodiscard]] double countsOfCelsius(double celsius, const RadiometricParameters& parameters);

}  // namespace thermovox
