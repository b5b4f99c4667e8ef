#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "projection/radiometric_overrides.hpp"

namespace thermovox {

/// What the user knows better than an image file.
struct ImageKnowledge {
  RadiometricOverrides radiometry;
  std::optional<TLinear> t_linear;  ///< of a TIFF of counts

  [[nodiscard]] bool any() const { return radiometry.any() || t_linear; }
};

/// What `thermovox info` says of an image file: camera, size, what its counts mean, and its first frame's
/// temperatures (C). `radiometric` is false, with the `reason`, where there are none. Throws DataError when
/// the file has no place for what the user knows.
[[nodiscard]] nlohmann::ordered_json imageInfo(const std::filesystem::path& file,
                                               const ImageKnowledge& knowledge);

}  // namespace thermovox
