#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "projection/radiometry.hpp"

namespace thermovox::simulate {

/// A radiometric JPEG of FLIR's kind: a grey picture that stretches from the coldest to the hottest pixel,
/// and in APP1 segments an FFF block with the raw counts (row by row, little-endian) and what they mean.
/// Throws DataError naming the file that could not be written.
void writeRadiometricJpeg(const std::filesystem::path& path, int width, std::span<const std::uint16_t> counts,
                          const RadiometricParameters& parameters);

}  // namespace thermovox::simulate
