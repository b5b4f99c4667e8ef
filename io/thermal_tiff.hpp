#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "projection/radiometry.hpp"
#include "projection/thermal_image.hpp"

namespace thermovox {

/// Reads one page (from 0) of a thermal TIFF: counts of 16 bits, decoded by `t_linear`, or 32-bit floats that
/// are Celsius already. Strips or tiles, any compression and byte order that libtiff knows; the orientation
/// is as stored. A value that no surface can have (absolute zero and below, infinite) becomes NaN. Throws
/// DataError naming the file: no such page, truncated, another kind of pixel, or absurdly large.
[[nodiscard]] ThermalImage readThermalTiff(const std::filesystem::path& file, int page,
                                           const TLinear& t_linear);

/// The same from the bytes of such a file; `name` stands for it in messages.
[[nodiscard]] ThermalImage readThermalTiff(std::span<const std::byte> bytes, const std::string& name,
                                           int page, const TLinear& t_linear);

/// What the numbers in a thermal TIFF are.
enum class ThermalPixels {
  counts,   ///< of 16 bits; only with the camera's scale do they become temperatures
  celsius,  ///< 32-bit floats
};

/// Of the first page. Throws DataError as readThermalTiff does.
[[nodiscard]] ThermalPixels thermalTiffPixels(const std::filesystem::path& file);

/// How many pages the file has. Throws DataError when it is no TIFF.
[[nodiscard]] int thermalTiffPages(const std::filesystem::path& file);

}  // namespace thermovox
