#pragma once

#include <optional>
#include <span>
#include <string>

#include "io/palette.hpp"
#include "io/splat_view.hpp"
#include "mapping/surface_cloud.hpp"

namespace thermovox {

/// What stands behind the map.
enum class Backdrop {
  dark,   ///< with room for a title above the map
  white,  ///< for print, without that room
};

/// What the colours of a map's picture say.
enum class PictureStyle {
  split,        ///< one half of the map grey, as the laser saw it, the other by temperature
  temperature,  ///< all by temperature
};

struct MapPictureOptions {
  std::string title;         ///< e.g. the mission's name
  double resolution = 0.05;  ///< edge of a cell, metres: how large a point is drawn
  PictureStyle style = PictureStyle::split;
  Backdrop backdrop = Backdrop::dark;
  Palette palette = Palette::inferno;
  std::optional<TemperatureSpan> span;  ///< Celsius; default: nearly all that is in the map
  /// Of the scale: 1 is linear; less gives the cool surfaces more of the palette, so that they and a few hot
  /// spots show at once.
  double exponent = 0.5;
  double azimuth_deg = -58.0;   ///< whence the map is seen, about z from the map's longer horizontal side
  double elevation_deg = 38.0;  ///< above the horizon, over 0 and under 90
  double cut_height = 0.72;     ///< share of the map's height above which all is cut away: the ceiling
  int width_px = 1600;
  int height_px = 900;
  void validate() const;  ///< throws ConfigError naming the option and its value
};

/// A map as it was drawn, nothing written into it.
struct MapView {
  RgbPicture picture;
  PictureView view;
  TemperatureScale scale;
};

/// Draws a map as seen from above at an angle, ceiling and the walls towards the viewer cut away. Points
/// without temperature are grey. Throws DataError when there are no points, ConfigError for an impossible
/// option.
[[nodiscard]] MapView drawMap(std::span<const SurfacePoint> points, const MapPictureOptions& options);

}  // namespace thermovox
