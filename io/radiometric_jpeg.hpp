#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/thermal_recording.hpp"

namespace thermovox {

/// The FLIR frame in a JPEG: the pieces in its APP1 segments, put together in the order of their numbers, or
/// as they stand where all have the number 0. Throws DataError naming the file: a piece is missing, or there
/// is none at all, with what the file is instead.
[[nodiscard]] std::vector<std::byte> flirFrameOfJpeg(std::span<const std::byte> bytes,
                                                     const std::string& name);

/// A radiometric JPEG of FLIR, or of DJI's Zenmuse XT. Throws DataError as flirFrameOfJpeg() does.
[[nodiscard]] std::unique_ptr<ThermalRecording> openRadiometricJpeg(
    std::span<const std::byte> bytes, const std::string& name, VisibleInFrame visible = VisibleInFrame::read);

}  // namespace thermovox
