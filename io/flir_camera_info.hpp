#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "io/raw_thermal_image.hpp"

namespace thermovox {

/// The record of a FLIR frame about its camera.
struct FlirCameraInfo {
  /// nullopt where the record holds no usable Planck constants. What is missing or impossible in the others
  /// (an emissivity of 0) has its usual value instead.
  std::optional<RadiometricParameters> parameters;
  ThermalMetadata metadata;
};

/// Reads as much as is there: the records of older cameras are shorter. Temperatures in the record are
/// kelvin.
[[nodiscard]] FlirCameraInfo parseFlirCameraInfo(std::span<const std::byte> bytes);

}  // namespace thermovox
