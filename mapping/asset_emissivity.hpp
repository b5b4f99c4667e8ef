#pragma once

#include <optional>

#include "mapping/hotspot.hpp"

namespace thermovox {

/// What a mission took its surfaces for when it made temperatures of their radiation.
struct AssumedSurface {
  double emissivity = 0.95;  ///< 0.05 to 1
  double reflected = 20.0;   ///< temperature of what the surface mirrors, C
};

/// The temperature of a surface whose emissivity e' is another than the assumed e: the T' that radiates what
/// was measured,
///   e S(T) + (1 - e) S(R) = e' S(T') + (1 - e') S(R),   S(T) = 1 / (exp(1430 K / T) - 1),
/// with R what it mirrors. Air and windows are not in it: they were taken off before. Nullopt where no
/// temperature radiates that little, as of a shiny part that mirrors something warmer than itself. The sigma
/// grows as the temperature does with its radiation, by about e / e'; what e' and R are wrong by is not in
/// it.
///
/// An approximation in two ways. A cell holds the mean of temperatures, not of radiation: exact where they
/// differ little. And S is that of a typical uncooled camera (8 to 14 um), as a station does not keep the
/// camera's own: with 1360 or 1510 K in the place of 1430, what is corrected from 0.95 to 0.6 at 100 C (33 C)
/// would be another by 0.9 C.
[[nodiscard]] std::optional<Estimate> withEmissivity(const Estimate& celsius, const AssumedSurface& assumed,
                                                     double emissivity);

}  // namespace thermovox
