#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "io/mission_folder.hpp"
#include "io/palette.hpp"
#include "io/station_hotspots.hpp"

namespace thermovox {

/// A part of a camera's image around a hot spot.
struct FrameCrop {
  std::string bytes;  ///< of a PNG (thermal) or a JPEG (visible)
  int width_px = 0;   ///< of this picture, which is enlarged or reduced
  int height_px = 0;
  Eigen::Vector2d spot_px;                ///< where the spot is in it
  Time stamp;                             ///< of the frame
  std::string name;                       ///< of its file
  Eigen::Vector2d pixel;                  ///< (u, v) of the spot in the whole frame
  std::optional<TemperatureScale> scale;  ///< of a thermal one
};

/// What the cameras saw of a hot spot.
struct SpotImages {
  std::optional<FrameCrop> thermal;  ///< of the frame that saw it best
  std::optional<FrameCrop> visible;  ///< of the visible picture nearest to that frame in time
};

/// By a hot spot's id.
using SpotImagesById = std::map<int, SpotImages>;

/// Cuts the images of those hot spots that this mission is the last to have seen, out of the frames in its
/// folder. Where a radiometric frame knows its air, it is shown through the air of the spot's distance. A
/// spot that no frame is known to have seen, or that lies outside the visible picture, has none. Throws
/// DataError for a mission that the station does not hold or that lacks the frame which saw a spot, and for
/// images that cannot be read.
[[nodiscard]] SpotImagesById cutSpotImages(const StationHotspots& found, OpenedMission& opened);

}  // namespace thermovox
