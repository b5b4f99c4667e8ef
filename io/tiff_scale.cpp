#include "io/tiff_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "io/flir_records.hpp"
#include "io/xmp.hpp"

namespace thermovox {
namespace {

/// A scale and the temperatures that cameras with it measure, C.
struct Scale {
  TLinear t_linear;
  double lowest = -40.0;
  double highest = 150.0;
};

// Hundredths of a kelvin: Duo R, Lepton, Altum. 0.04 and 0.4 K: high and low gain of the Tau family (Duo Pro
// R, Vue Pro R, Zenmuse XT, Wiris). 0.1 K: Lepton's other setting. Their counts do not overlap.
constexpr Scale kHundredth{{0.01, kAbsoluteZero}};
constexpr Scale kHighGain{{0.04, kAbsoluteZero}};
constexpr Scale kTenth{{0.1, kAbsoluteZero}};
constexpr Scale kLowGain{{0.4, kAbsoluteZero}, -40.0, 550.0};
constexpr std::array kBands{kHundredth, kHighGain, kTenth, kLowGain};
/// senseFly's thermoMAP: hundredths of a degree above -100 C.
constexpr Scale kThermoMap{{0.01, -100.0}};

/// A camera by the beginnings of its make and model, and the scales it can have.
struct KnownCamera {
  std::string_view make;
  std::string_view model;
  std::array<Scale, 2> scales;
};
constexpr std::array kKnownCameras{
    KnownCamera{"senseFly", "thermoMAP", {kThermoMap, kThermoMap}},
    KnownCamera{"MicaSense", "Altum", {kHundredth, kHundredth}},
    KnownCamera{"FLIR", "Duo R", {kHundredth, kHundredth}},
    KnownCamera{"FLIR", "Duo Pro R", {kHighGain, kLowGain}},
    KnownCamera{"FLIR", "Vue Pro R", {kHighGain, kLowGain}},
    KnownCamera{"DJI", "FLIR", {kHighGain, kLowGain}},
    KnownCamera{"DJI", "XT", {kHighGain, kLowGain}},
    KnownCamera{"", "WIRIS", {kHighGain, kLowGain}},
};

/// Where most of an image lies: single hot or dead pixels say nothing about the scale.
struct Band {
  double low = 0.0;
  double high = 0.0;
};

/// By a few thousand pixels, evenly spread.
std::optional<Band> bandOf(std::span<const std::uint16_t> counts) {
  const std::size_t step = std::max<std::size_t>(1, counts.size() / 4096);
  std::vector<std::uint16_t> known;
  for (std::size_t i = 0; i < counts.size(); i += step) {
    if (counts[i] > 0) known.push_back(counts[i]);
  }
  if (known.empty()) return std::nullopt;
  std::sort(known.begin(), known.end());
  const auto at = [&known](std::size_t percent) {
    return static_cast<double>(known[(known.size() - 1) * percent / 100]);
  };
  return Band{at(1), at(99)};
}

bool holds(const Scale& scale, const Band& band) {
  const auto celsius = [&scale](double count) {
    return count * scale.t_linear.celsius_per_count + scale.t_linear.celsius_offset;
  };
  return celsius(band.low) >= scale.lowest && celsius(band.high) <= scale.highest;
}

std::optional<ScaleDecision> byXmp(const TiffEvidence& evidence) {
  const std::optional<double> gain = xmpNumber(evidence.xmp, "TlinearGain");
  if (!gain) return std::nullopt;
  if (*gain > 0.0) return ScaleDecision{TLinear{*gain, kAbsoluteZero}, RuleSource::file};
  return ScaleDecision{NotTemperature{"says itself that its counts are no temperatures (TlinearGain is " +
                                      fmt::format("{}", *gain) + ")"},
                       RuleSource::file};
}

std::optional<ScaleDecision> byModel(const TiffEvidence& evidence, const std::optional<Band>& band) {
  if (evidence.make.starts_with("FLIR") && measuresNoTemperatures(evidence.model)) {
    return ScaleDecision{NotTemperature{"is of a " + evidence.model +
                                        ", which measures no temperatures (only the models with an R do)"},
                         RuleSource::model};
  }
  for (const auto& [make, model, scales] : kKnownCameras) {
    if (!evidence.make.starts_with(make) || !evidence.model.starts_with(model)) continue;
    const bool second = band && !holds(scales[0], *band) && holds(scales[1], *band);
    return ScaleDecision{scales[second ? 1 : 0].t_linear, RuleSource::model};
  }
  return std::nullopt;
}

ScaleDecision byBand(const std::optional<Band>& band) {
  for (const Scale& scale : kBands) {
    if (band && holds(scale, *band)) return {scale.t_linear, RuleSource::counts};
  }
  const std::string found = band ? fmt::format("{:.0f} to {:.0f}", band->low, band->high) : "0";
  return {NotTemperature{"does not say what its counts (" + found +
                         ") mean, and they lie in no range of a known camera; give celsius_per_count and "
                         "celsius_offset"},
          RuleSource::counts};
}

}  // namespace

ScaleDecision decideScale(const TiffEvidence& evidence, std::span<const std::uint16_t> counts) {
  if (evidence.option) return {*evidence.option, RuleSource::option};
  if (auto decision = byXmp(evidence)) return *decision;
  const std::optional<Band> band = bandOf(counts);
  if (auto decision = byModel(evidence, band)) return *decision;
  return byBand(band);
}

}  // namespace thermovox
