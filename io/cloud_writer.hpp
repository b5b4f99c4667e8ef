#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "io/atomic_file.hpp"
#include "io/palette.hpp"
#include "mapping/surface_cloud.hpp"

namespace thermovox {

/// How temperatures become colours in an export.
struct ColourScale {
  Palette palette = Palette::inferno;
  std::optional<TemperatureSpan>
      span;  ///< Celsius; default: the 2nd to the 98th percentile of what is exported
};

/// The scale's own span, or that of the points; 0 to 1 C where none has a temperature.
[[nodiscard]] TemperatureSpan spanOf(std::span<const SurfacePoint> points, const ColourScale& scale);

/// Binary PCD: x y z (float, metres) rgb temperature temperature_sigma (float, C; NaN where no frame saw the
/// cell) count (uint32) time (double, Unix seconds of the last observation; NaN without). Throws DataError as
/// AtomicFile does; so do all below.
void writePcd(const std::filesystem::path& path, std::span<const SurfacePoint> points,
              const ColourScale& scale, Existing existing);

/// Binary little-endian PLY: the same, with red green blue as bytes and the scalars called
/// scalar_temperature (first of them), scalar_temperature_sigma, scalar_count, scalar_time, as CloudCompare
/// keeps them.
void writePly(const std::filesystem::path& path, std::span<const SurfacePoint> points,
              const ColourScale& scale, Existing existing);

/// CSV with one header row of the PCD's names; rgb is one whole number, 65536 red + 256 green + blue;
/// "nan" is not known.
void writeCloudCsv(const std::filesystem::path& path, std::span<const SurfacePoint> points,
                   const ColourScale& scale, Existing existing);

/// One of the above, or writeLas() of las_writer.hpp, by the path's ending (.pcd .ply .csv .las). Throws
/// ConfigError for another one.
void writeCloud(const std::filesystem::path& path, std::span<const SurfacePoint> points,
                const ColourScale& scale, Existing existing);

}  // namespace thermovox
