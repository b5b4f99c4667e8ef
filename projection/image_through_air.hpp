#pragma once

#include <span>

#include "projection/thermal_image.hpp"

namespace thermovox {

/// The image with the air on the way to each pixel's surface put into its temperature: `distances` from the
/// camera, row by row, metres. NaN where none is known, or no temperature fits what was counted. The result
/// has no air left; an image without any is the same. Precondition: a distance for every pixel.
[[nodiscard]] ThermalImage imageThroughAir(const ThermalImage& image, std::span<const double> distances);

}  // namespace thermovox
