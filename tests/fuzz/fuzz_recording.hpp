#pragma once

#include <cmath>
#include <span>
#include <variant>

#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace thermovox::fuzz {

/// What every decoder owes: a whole image.
inline void checkSize(const RawThermalImage& image) {
  require(image.width > 0 && image.height > 0);
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  require(image.counts.size() + image.celsius.size() == pixels);
}

/// Its temperatures can be.
inline void checkTemperatures(const RawThermalImage& image) {
  if (std::holds_alternative<NotTemperature>(image.rule)) return;
  const ThermalImage decoded = CelsiusDecoder().decode(image, "fuzz");
  require(decoded.celsius.size() == image.counts.size() + image.celsius.size());
  for (const float celsius : decoded.celsius)
    require(std::isnan(celsius) || (std::isfinite(celsius) && celsius > kAbsoluteZero));
}

/// Opens a recording and reads some of its frames; a table of temperatures takes long, so of one alone.
template <typename Open>
void readRecording(Open&& open) {
  read([&] {
    const std::unique_ptr<ThermalRecording> recording = open();
    require(recording->frames() > 0);
    for (const int frame : {1, recording->frames() - 1}) {
      read([&] { checkSize(recording->read(frame)); });
    }
    const RawThermalImage first = recording->read(0);
    checkSize(first);
    checkTemperatures(first);
  });
}

}  // namespace thermovox::fuzz
