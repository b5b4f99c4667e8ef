#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "projection/radiometric_overrides.hpp"
#include "projection/rig.hpp"
#include "projection/sources.hpp"

namespace thermovox {

/// A recording of the thermal camera in a mission folder.
struct FrameRecording {
  std::filesystem::path list;               ///< thermal.csv: `timestamp,file[,page]`
  std::filesystem::path folder;             ///< what the list's files are relative to
  Duration time_offset = Duration::zero();  ///< added to the stamps
  /// Instead of what radiometric files say. Their distance is that of each point: it is not asked for.
  RadiometricOverrides radiometry;
  std::optional<double>
      ambient;  ///< of the air, C: instead of what radiometric files say, where there are any
  /// Hears what the user should know of the frames' scale (scaleWarning), of the first frame it holds for;
  /// may be empty.
  std::function<void(const std::string&)> warn;
};

/// A source that reads the frames one at a time. It goes through the list once at the start, for the frames'
/// period (the median of their distances), and holds one image at a time. What the counts of TIFFs are the
/// camera says; where it does not, decideScale() does for each.
/// Throws DataError naming file and line of what is wrong with the list, or when it lists no image; next()
/// also for an image that is missing, damaged or not of the camera's size.
[[nodiscard]] std::unique_ptr<FrameSource> readFrames(const FrameRecording& recording,
                                                      const ThermalCamera& camera);

}  // namespace thermovox
