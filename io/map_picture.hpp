#pragma once

#include <filesystem>
#include <span>

#include "io/atomic_file.hpp"
#include "io/map_view.hpp"

namespace thermovox {

/// Writes drawMap()'s picture as PNG, with a title and a scale in degrees Celsius. Throws as drawMap() and
/// AtomicFile do.
void writeMapPicture(const std::filesystem::path& path, std::span<const SurfacePoint> points,
                     const MapPictureOptions& options, Existing existing);

}  // namespace thermovox
