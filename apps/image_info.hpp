#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace thermovox {

/// What `thermovox info` says of an image file: camera, size, what its counts mean, and its first frame's
/// temperatures (C). `radiometric` is false, with the `reason`, where there are none.
[[nodiscard]] nlohmann::ordered_json imageInfo(const std::filesystem::path& file);

}  // namespace thermovox
