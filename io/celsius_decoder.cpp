#include "io/celsius_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "projection/error.hpp"

namespace thermovox {
namespace {

/// What cannot be is the file's own.
CelsiusTable tableFor(const RadiometricParameters& parameters, const std::string& name) {
  try {
    return CelsiusTable(parameters);
  } catch (const ConfigError& error) {
    throw DataError(name + ": " + error.what());
  }
}

}  // namespace

ThermalImage CelsiusDecoder::decode(const RawThermalImage& image, const std::string& name,
                                    const RadiometricOverrides& overrides) {
  if (const auto* none = std::get_if<NotTemperature>(&image.rule))
    throw DataError(name + ": " + none->reason);
  ThermalImage result{.width = image.width,
                      .height = image.height,
                      .celsius = {},
                      .air = nullptr,
                      .calibrated_range = image.metadata.calibrated_range};
  if (const auto* parameters = std::get_if<RadiometricParameters>(&image.rule)) {
    overrides.validate();
    const RadiometricParameters wanted = overrides.applyTo(*parameters);
    if (!table_ || !(table_->parameters() == wanted)) table_.emplace(tableFor(wanted, name));
    result.noise_gain = static_cast<float>(1.0 / (wanted.emissivity * wanted.window_transmission));
    result.celsius.resize(image.counts.size());
    table_->convert(image.counts, result.celsius);
    return result;
  }
  if (overrides.any()) {
    throw DataError(name +
                    ": its temperatures are of the camera's own making, expected a file with radiometric "
                    "parameters (FLIR) where one of them is to be replaced");
  }
  if (const auto* t_linear = std::get_if<TLinear>(&image.rule)) {
    result.celsius.resize(image.counts.size());
    std::transform(image.counts.begin(), image.counts.end(), result.celsius.begin(),
                   [scale = *t_linear](std::uint16_t count) { return scale.celsius(count); });
  } else {
    result.celsius = image.celsius;
  }
  return result;
}

ThermalStatistics statisticsOf(const ThermalImage& image, const std::optional<CalibratedRange>& range) {
  ThermalStatistics statistics;
  double sum = 0.0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const float celsius : image.celsius) {
    if (!std::isfinite(celsius)) {
      ++statistics.unknown;
      continue;
    }
    sum += celsius;
    low = std::min<double>(low, celsius);
    high = std::max<double>(high, celsius);
    if (range && range->isBelow(celsius)) ++statistics.below_range;
    if (range && range->isAbove(celsius)) ++statistics.above_range;
  }
  const std::size_t known = image.celsius.size() - statistics.unknown;
  if (known == 0) return statistics;
  statistics.min = low;
  statistics.mean = sum / static_cast<double>(known);
  statistics.max = high;
  return statistics;
}

}  // namespace thermovox
