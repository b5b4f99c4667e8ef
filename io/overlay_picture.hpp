#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/palette.hpp"
#include "io/visible_edges.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// A laser point as a thermal frame sees it.
struct OverlayPoint {
  Eigen::Vector2d pixel;
  double range = 0.0;    ///< the laser's own reading, metres
  double celsius = 0.0;  ///< temperature read there
  double sigma = 0.0;    ///< of it, C
  std::string label;     ///< name of a chosen point ("left", "centre"); empty for the others
};

struct OverlayOptions {
  std::string title;
  Palette palette = Palette::inferno;
  std::optional<TemperatureSpan> span;  ///< Celsius; default: calibratedSpan(), 1st to 99.9th percentile
  std::shared_ptr<const RegisteredPicture> visible;  ///< whose edges are drawn into the image; may be null
  int width_px = 1280;  ///< of the picture; the image is enlarged by a whole factor to about it
};

/// Draws laser points on the thermal image they were coloured by: each a dot whose colour is its distance,
/// and beside the chosen ones their temperature and distance; scales for both below, and
/// what the colours of pixels outside the image's calibrated range mean. PNG, written whole or not at all.
/// Throws DataError as AtomicFile does.
void writeOverlayPicture(const std::filesystem::path& path, const ThermalImage& image,
                         std::span<const OverlayPoint> points, const OverlayOptions& options,
                         Existing existing);

}  // namespace thermovox
