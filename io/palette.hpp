#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace thermovox {

/// Colour tables of thermal pictures. None holds 255 255 255, which OctoMap's colour tree takes for "unset".
enum class Palette {
  inferno,    ///< black, violet, orange, pale yellow: perceptually even (the table of matplotlib)
  magma,      ///< black, violet, pink, pale yellow: as even
  viridis,    ///< violet, teal, green, yellow: as even
  cividis,    ///< blue to yellow: as even, and the same to eyes that see no red or green
  ironbow,    ///< black, blue, magenta, orange, cream: as thermal cameras show
  rainbow,    ///< blue, cyan, green, yellow, red
  grey,       ///< dark to light
  black_hot,  ///< light to dark
};

/// A palette and its name in commands.
struct NamedPalette {
  std::string_view name;
  Palette palette;
};

/// All of them.
[[nodiscard]] std::span<const NamedPalette> namedPalettes();

struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// What has no temperature is drawn in this grey.
inline constexpr Rgb kUnknownColour{128, 128, 128};

/// In pictures with a palette, what lies outside the temperatures that the camera is calibrated for: colours
/// that the palette itself does not come near.
struct UncalibratedColours {
  Rgb below;
  Rgb above;
};
[[nodiscard]] UncalibratedColours uncalibratedColours(Palette palette);

/// The palette of a name; nullopt for any other.
[[nodiscard]] std::optional<Palette> paletteOf(std::string_view name);

/// Colour at a place of the palette, 0 (cold) to 1 (hot); what lies outside takes the end's colour, NaN is
/// kUnknownColour.
[[nodiscard]] Rgb colourAt(Palette palette, double fraction);

/// The temperatures that the two ends of a palette stand for, Celsius.
struct TemperatureSpan {
  double low = 0.0;
  double high = 1.0;
  friend bool operator==(const TemperatureSpan&, const TemperatureSpan&) = default;
};

/// The span between two percentiles (0..100) of the temperatures, NaN left out; nullopt when nothing is left.
/// Where both are equal the span is widened to one degree about them.
[[nodiscard]] std::optional<TemperatureSpan> percentileSpan(std::span<const float> celsius,
                                                            double low_percentile = 2.0,
                                                            double high_percentile = 98.0);

/// Colour of a temperature; NaN is kUnknownColour. Precondition: span.low < span.high.
[[nodiscard]] Rgb colourOf(double celsius, const TemperatureSpan& span, Palette palette);

/// How a picture turns temperatures into colours: the place in the palette is the place in the span to the
/// power of `exponent` (1: linear; less gives the cool end more of the palette).
struct TemperatureScale {
  TemperatureSpan span;
  Palette palette = Palette::inferno;
  double exponent = 1.0;

  /// 0 at the span's low end and below, 1 at its high end and above; NaN for NaN.
  [[nodiscard]] double placeOf(double celsius) const;
  [[nodiscard]] Rgb colourOf(double celsius) const { return colourAt(palette, placeOf(celsius)); }
};

}  // namespace thermovox
