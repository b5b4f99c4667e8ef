#pragma once

#include <memory>

#include "io/thermal_recording.hpp"

namespace thermovox {

/// A TIFF whose pages are counts of 16 bits or 32-bit floats that are Celsius already. Strips or tiles, any
/// compression and byte order that libtiff knows, BigTIFF, with or without its photometric tag. Of floats, a
/// value that no surface can have (absolute zero and below, infinite) becomes NaN. What counts are is decided
/// by decideScale(). Throws DataError naming the file: truncated, another kind of pixel, absurdly large.
[[nodiscard]] std::unique_ptr<ThermalRecording> openThermalTiff(const std::filesystem::path& file,
                                                                const RecordingOptions& options);

/// The same from the bytes of such a file, which have to outlive it; `name` stands for it in messages.
[[nodiscard]] std::unique_ptr<ThermalRecording> openThermalTiff(std::span<const std::byte> bytes,
                                                                const std::string& name,
                                                                const RecordingOptions& options);

}  // namespace thermovox
