#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io/raw_thermal_image.hpp"

namespace thermovox {

/// All that may say what the counts of a TIFF are.
struct TiffEvidence {
  std::optional<TLinear> option;  ///< of the user, or of the rig of a mission
  std::string xmp;                ///< the packet
  std::string make, model;
};

struct ScaleDecision {
  CelsiusRule rule;
  RuleSource source = RuleSource::file;
};

/// Decides what the counts are. The first that speaks wins: the user; the packet's TlinearGain, of which 0
/// says that they are no temperatures; make and model, of cameras whose scale is known (of those with two,
/// the one whose range the counts lie in); the band that the counts lie in, which is a guess. Where nothing
/// speaks the rule is NotTemperature. Counts of 0 are empty pixels and have no say.
[[nodiscard]] ScaleDecision decideScale(const TiffEvidence& evidence, std::span<const std::uint16_t> counts);

}  // namespace thermovox
