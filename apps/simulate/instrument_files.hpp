#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "projection/laser/multi_beam.hpp"

namespace thermovox::simulate {

/// Writers of what a mission's instruments leave behind. All throw DataError naming the file that could not
/// be written.

/// 16-bit TIFF, one page, LZW with horizontal differencing; counts row by row.
void writeThermalTiff(const std::filesystem::path& path, int width, std::span<const std::uint16_t> counts);

/// Whether a cloud's points tell their times: those of one that was taken standing still need not.
enum class PointTimes { written, left_out };

/// Binary PCD 0.7 with the float fields x y z intensity and, if written, time.
void writeCloudPcd(const std::filesystem::path& path, std::span<const CloudPoint> points,
                   PointTimes times = PointTimes::written);

void writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace thermovox::simulate
