#include "projection/air_path.hpp"

namespace thermovox {

AirPath::AirPath(const RadiometricParameters& parameters)
    : parameters_(parameters), single_(0.0), half_(0.0) {
  parameters_.validate();
  const bool half = parameters.model == AtmosphereModel::half;
  (half ? half_ : single_) = 1.0;
  const double root_water = std::sqrt(waterInAir(parameters_));
  const double per_root = half ? std::sqrt(0.5) : 1.0;
  const AtmosphereConstants& c = parameters_.atmosphere;
  decay1_ = per_root * (c.alpha1 + c.beta1 * root_water);
  decay2_ = per_root * (c.alpha2 + c.beta2 * root_water);

  const double e = parameters_.emissivity;
  const double w = parameters_.window_transmission;
  const double air = parameters_.planck.signal(parameters_.atmosphere_temperature);
  const double window = (1.0 - w) / (e * w) * parameters_.planck.signal(parameters_.window_temperature);
  const double reflected = (1.0 - e) / e * parameters_.planck.signal(parameters_.reflected);
  over_window_ = half ? window - air / (e * w) : 0.0;
  over_air_ = half ? reflected : reflected - air / e;
  over_half_ = half ? -air / e : 0.0;
}

}  // namespace thermovox
