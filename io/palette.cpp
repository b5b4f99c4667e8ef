#include "io/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace thermovox {
namespace {

// Evenly spaced colours of each table; between them the colour changes linearly.
constexpr std::array kInferno{Rgb{0, 0, 4},      Rgb{27, 12, 65},   Rgb{74, 12, 107},  Rgb{120, 28, 109},
                              Rgb{165, 44, 96},  Rgb{207, 68, 70},  Rgb{237, 105, 37}, Rgb{251, 155, 6},
                              Rgb{247, 209, 61}, Rgb{252, 255, 164}};
constexpr std::array kMagma{Rgb{0, 0, 4},       Rgb{24, 15, 61},   Rgb{69, 16, 119}, Rgb{114, 31, 129},
                            Rgb{158, 47, 127},  Rgb{205, 64, 113}, Rgb{241, 96, 93}, Rgb{253, 148, 103},
                            Rgb{254, 202, 141}, Rgb{252, 253, 191}};
constexpr std::array kViridis{Rgb{68, 1, 84},    Rgb{72, 40, 120},  Rgb{62, 74, 137},  Rgb{49, 104, 142},
                              Rgb{38, 130, 142}, Rgb{31, 158, 137}, Rgb{53, 183, 121}, Rgb{108, 205, 90},
                              Rgb{181, 222, 43}, Rgb{253, 231, 37}};
constexpr std::array kCividis{Rgb{0, 34, 78},     Rgb{18, 53, 112},   Rgb{60, 74, 108},   Rgb{87, 93, 109},
                              Rgb{112, 113, 115}, Rgb{138, 134, 120}, Rgb{165, 156, 116}, Rgb{194, 179, 105},
                              Rgb{225, 204, 85},  Rgb{254, 232, 56}};
constexpr std::array kIronbow{Rgb{2, 0, 10},     Rgb{30, 0, 110},   Rgb{90, 0, 155},  Rgb{150, 0, 155},
                              Rgb{195, 25, 120}, Rgb{225, 65, 40},  Rgb{240, 110, 5}, Rgb{250, 160, 0},
                              Rgb{255, 210, 50}, Rgb{255, 250, 215}};
constexpr std::array kRainbow{Rgb{20, 30, 160},  Rgb{0, 110, 250}, Rgb{0, 200, 220}, Rgb{40, 190, 70},
                              Rgb{190, 220, 30}, Rgb{250, 190, 0}, Rgb{240, 90, 10}, Rgb{180, 10, 20}};
constexpr std::array kGrey{Rgb{20, 20, 20}, Rgb{240, 240, 240}};
constexpr std::array kBlackHot{Rgb{240, 240, 240}, Rgb{20, 20, 20}};

constexpr std::array kNamed{
    NamedPalette{"inferno", Palette::inferno}, NamedPalette{"magma", Palette::magma},
    NamedPalette{"viridis", Palette::viridis}, NamedPalette{"cividis", Palette::cividis},
    NamedPalette{"ironbow", Palette::ironbow}, NamedPalette{"rainbow", Palette::rainbow},
    NamedPalette{"grey", Palette::grey},       NamedPalette{"black-hot", Palette::black_hot}};

std::span<const Rgb> tableOf(Palette palette) {
  switch (palette) {
    case Palette::inferno:
      return kInferno;
    case Palette::magma:
      return kMagma;
    case Palette::viridis:
      return kViridis;
    case Palette::cividis:
      return kCividis;
    case Palette::black_hot:
      return kBlackHot;
    case Palette::ironbow:
      return kIronbow;
    case Palette::rainbow:
      return kRainbow;
    case Palette::grey:
      break;
  }
  return kGrey;
}

std::uint8_t blend(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
}

/// Linear between the order statistics around the percentile; reorders the values.
double percentileOf(std::vector<float>& values, double percentile) {
  const double place = std::clamp(percentile, 0.0, 100.0) / 100.0 * static_cast<double>(values.size() - 1);
  const auto lower = values.begin() + static_cast<std::ptrdiff_t>(std::floor(place));
  std::nth_element(values.begin(), lower, values.end());
  const double share = place - std::floor(place);
  if (share == 0.0) return *lower;
  const float upper = *std::min_element(lower + 1, values.end());
  return *lower + share * (upper - *lower);
}

}  // namespace

std::span<const NamedPalette> namedPalettes() {
  return kNamed;
}

UncalibratedColours uncalibratedColours(Palette palette) {
  const bool green = palette == Palette::viridis || palette == Palette::rainbow;
  return green ? UncalibratedColours{{255, 0, 255}, {255, 240, 255}}
               : UncalibratedColours{{0, 255, 255}, {0, 255, 0}};
}

std::optional<Palette> paletteOf(std::string_view name) {
  for (const NamedPalette& known : kNamed) {
    if (known.name == name) return known.palette;
  }
  return std::nullopt;
}

Rgb colourAt(Palette palette, double fraction) {
  if (std::isnan(fraction)) return kUnknownColour;
  const std::span<const Rgb> table = tableOf(palette);
  const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), table.size() - 2);
  const double share = place - static_cast<double>(below);
  const Rgb& a = table[below];
  const Rgb& b = table[below + 1];
  return {blend(a.r, b.r, share), blend(a.g, b.g, share), blend(a.b, b.b, share)};
}

std::optional<TemperatureSpan> percentileSpan(std::span<const float> celsius, double low_percentile,
                                              double high_percentile) {
  std::vector<float> known;
  known.reserve(celsius.size());
  std::copy_if(celsius.begin(), celsius.end(), std::back_inserter(known),
               [](float c) { return std::isfinite(c); });
  if (known.empty()) return std::nullopt;
  const double low = percentileOf(known, low_percentile);
  const double high = percentileOf(known, high_percentile);
  if (low < high) return TemperatureSpan{low, high};
  return TemperatureSpan{low - 0.5, low + 0.5};
}

Rgb colourOf(double celsius, const TemperatureSpan& span, Palette palette) {
  return colourAt(palette, (celsius - span.low) / (span.high - span.low));
}

double TemperatureScale::placeOf(double celsius) const {
  if (std::isnan(celsius)) return celsius;
  return std::pow(std::clamp((celsius - span.low) / (span.high - span.low), 0.0, 1.0), exponent);
}

}  // namespace thermovox
