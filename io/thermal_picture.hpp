#pragma once

#include <filesystem>
#include <string>

#include "io/atomic_file.hpp"
#include "io/palette.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

struct ThermalPictureOptions {
  Palette palette = Palette::inferno;
  TemperatureSpan span;  ///< Celsius
  std::string note;      ///< a line below the scale; may be empty
};

/// Draws a thermal image by a palette, small ones enlarged by a whole factor, with a scale in C below it.
/// PNG, or JPEG by the path's ending; written whole or not at all. Throws DataError as AtomicFile does.
void writeThermalPicture(const std::filesystem::path& path, const ThermalImage& image,
                         const ThermalPictureOptions& options, Existing existing);

}  // namespace thermovox
