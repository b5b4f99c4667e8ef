#include "mapping/asset_emissivity.hpp"

#include <cmath>

#include "projection/portable_math.hpp"
#include "projection/radiometry.hpp"

namespace thermovox {
namespace {

constexpr PlanckConstants kTypical{.r1 = 1.0, .r2 = 1.0, .b = 1430.0, .f = 1.0, .o = 0.0};

/// dS / dT, 1/K.
double slopeOf(double celsius) {
  const double kelvin = celsius - kAbsoluteZero;
  const double signal = kTypical.signal(celsius);
  return kTypical.b / (kelvin * kelvin) * portableExp(kTypical.b / kelvin) * signal * signal;
}

}  // namespace

std::optional<Estimate> withEmissivity(const Estimate& celsius, const AssumedSurface& assumed,
                                       double emissivity) {
  if (emissivity == assumed.emissivity) return celsius;
  const double mirrored = kTypical.signal(assumed.reflected);
  const double measured = assumed.emissivity * (kTypical.signal(celsius.value) - mirrored);
  const double corrected = kTypical.celsius(mirrored + measured / emissivity);
  if (std::isnan(corrected)) return std::nullopt;
  const double growth = assumed.emissivity * slopeOf(celsius.value) / (emissivity * slopeOf(corrected));
  return Estimate{corrected, celsius.sigma * growth};
}

}  // namespace thermovox
