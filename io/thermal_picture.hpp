#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "io/atomic_file.hpp"
#include "io/palette.hpp"
#include "io/visible_edges.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// The span between two percentiles (0..100) of the temperatures that the camera is calibrated for: the
/// others have colours of their own. Of all temperatures where there are none, and 0 to 1 C without any.
[[nodiscard]] TemperatureSpan calibratedSpan(const ThermalImage& image, double low_percentile,
                                             double high_percentile);

struct ThermalPictureOptions {
  Palette palette = Palette::inferno;
  TemperatureSpan span;                              ///< Celsius
  std::string note;                                  ///< a line below the scale; may be empty
  std::shared_ptr<const RegisteredPicture> visible;  ///< whose edges are drawn into the image; may be null
};

/// Draws a thermal image by a palette, small ones enlarged by a whole factor, with a scale in C below it.
/// Pixels outside the image's calibrated range have colours of their own, which the scale explains. PNG, or
/// JPEG by the path's ending; written whole or not at all. Throws DataError as AtomicFile does.
void writeThermalPicture(const std::filesystem::path& path, const ThermalImage& image,
                         const ThermalPictureOptions& options, Existing existing);

}  // namespace thermovox
