#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/laser_start.hpp"
#include "calibration/laser_verdict.hpp"

namespace thermovox {

/// Why captures cannot be enough, whatever they are; none where they may be.
[[nodiscard]] std::optional<std::string> tooFewCaptures(const BundleData& data);

/// What is not determined, by how many captures, and what these lack.
[[nodiscard]] std::string undeterminedWords(const std::string& direction, const BundleData& data,
                                            const RigEstimate& estimate);

/// The same, where two answers cannot be told apart.
[[nodiscard]] std::string rivalWords(const LaserStart& start, const BundleData& data,
                                     const RigEstimate& estimate);

/// Why a capture does not count: how far its returns are off the board of the images.
[[nodiscard]] std::string movedWords(const PlaneMoments& plane, const RigEstimate& estimate,
                                     std::size_t capture, double probability);

/// What the boards' places lack, a sentence each: tilts, tilts about a second axis, distances.
[[nodiscard]] std::vector<std::string> geometryWords(const BundleData& data, const RigEstimate& estimate);

/// Puts the weakest direction into words, adds warnings, and withdraws `observable` where the direction is
/// not known at all.
void describe(LaserVerdict& verdict, const BundleData& data, const RigEstimate& estimate,
              double range_bias_sigma);

}  // namespace thermovox
