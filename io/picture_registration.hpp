#pragma once

#include <filesystem>
#include <string>

#include "io/visible_edges.hpp"

namespace thermovox {

/// A visible picture taken together with a thermal image, and how they belong together.
struct PictureByRig {
  std::filesystem::path visible;
  std::filesystem::path rig;  ///< with both cameras
  /// Of the surface, which is taken to face the thermal camera: metres along its optical axis. With one
  /// distance nothing is known to stand before another, so what only one of the cameras sees is not left out.
  double range = 0.0;
};

/// The visible picture on the pixels of a thermal image, by the rig's two cameras. `name` stands for the
/// thermal image in messages. Throws ConfigError for a rig without the two cameras and DataError for what is
/// missing, damaged, of another size than the rig says, or looks elsewhere.
[[nodiscard]] RegisteredPicture registerByRig(const PictureByRig& by, const RawThermalImage& thermal,
                                              const std::string& name);

/// The picture in a FLIR file on the pixels of the thermal image there, as the file says. Throws DataError
/// naming the file when it lacks the picture or where it lies, or one of them cannot be.
[[nodiscard]] RegisteredPicture registerByRecord(const RawThermalImage& thermal, const std::string& name);

}  // namespace thermovox
