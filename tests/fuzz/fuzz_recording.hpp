#pragma once

#include <cmath>
#include <span>
#include <variant>

#include "io/celsius_decoder.hpp"
#include "io/thermal_recording.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace thermovox::fuzz {

/// What every decoder owes: whole images, and temperatures that can be.
inline void checkImage(const RawThermalImage& image) {
  require(image.width > 0 && image.height > 0);
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  require(image.counts.size() + image.celsius.size() == pixels);
  if (std::holds_alternative<NotTemperature>(image.rule)) return;
  const ThermalImage decoded = CelsiusDecoder().decode(image, "fuzz");
  require(decoded.celsius.size() == pixels);
  for (const float celsius : decoded.celsius) {
    require(std::isnan(celsius) || (std::isfinite(celsius) && celsius > kAbsoluteZero));
  }
}

/// Opens a recording and reads its first frames.
template <typename Open>
void readRecording(Open&& open) {
  read([&] {
    const std::unique_ptr<ThermalRecording> recording = open();
    require(recording->frames() > 0);
    for (const int frame : {1, 0, recording->frames() - 1}) {
      read([&] { checkImage(recording->read(frame)); });
    }
  });
}

}  // namespace thermovox::fuzz
