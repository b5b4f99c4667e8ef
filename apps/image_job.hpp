#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/image_edges.hpp"
#include "io/atomic_file.hpp"
#include "io/palette.hpp"
#include "projection/radiometric_overrides.hpp"
#include "projection/radiometry.hpp"

namespace thermovox {

/// How `thermovox image` turns a thermal image into a file.
struct ImageJob {
  RadiometricOverrides overrides;
  std::optional<TLinear> t_linear;      ///< of TIFFs of counts
  std::optional<TLinear> rig_t_linear;  ///< likewise, where the user does not say it
  bool counts = false;                  ///< instead of temperatures
  int frame = 0;
  bool all = false;  ///< frames
  Palette palette = Palette::inferno;
  std::optional<TemperatureSpan> span;
  struct Percentiles {
    double low = 1.0;
    double high = 99.9;
  } percentile;    ///< of the image, where no span is given
  EdgeArgs edges;  ///< drawn into pictures
  Existing existing = Existing::refuse;
};

/// Whether the path's ending is that of a TIFF; other images are pictures.
[[nodiscard]] bool isTiff(const std::filesystem::path& path);

/// Writes the image `in` as `out`, a TIFF or a picture by its ending, and returns what there is to say of it:
/// size and temperatures. Throws DataError naming the file.
[[nodiscard]] std::string writeImage(const ImageJob& job, const std::filesystem::path& in,
                                     const std::filesystem::path& out);

}  // namespace thermovox
