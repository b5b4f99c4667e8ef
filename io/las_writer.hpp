#pragma once

#include <filesystem>
#include <span>

#include "io/cloud_writer.hpp"

namespace thermovox {

/// LAS 1.4 (R15), point format 7, with four extra bytes fields behind every point, named as in the PCD:
/// temperature, temperature_sigma (float, C; NaN where no frame saw the cell, which the file declares as "no
/// data"), count (uint32) and time (double, Unix seconds of the last temperature; NaN without).
///
/// Coordinates are whole steps of 0.1 mm from a whole metre near the cloud's middle (of 1 mm, 10 mm, ...
/// where the cloud is wider than 429 km). Intensity is the place of the temperature in the span, 1 at its low
/// end and below to 65535 at its high end and above; 0 where there is no temperature. Red, green and blue are
/// the palette's 8 bits times 257. The coordinate system is a local one in metres, z up. GPS time and the day
/// of creation are 0, for "not known": the clock of a mission is anybody's, and the same points give the same
/// bytes. Throws DataError as AtomicFile does.
void writeLas(const std::filesystem::path& path, std::span<const SurfacePoint> points,
              const ColourScale& scale, Existing existing);

}  // namespace thermovox
