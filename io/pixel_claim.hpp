#pragma once

#include <cstdint>
#include <string>

namespace thermovox {

/// No picture of a camera has more.
inline constexpr std::uint64_t kMostPixels = 100'000'000;

/// What the header of an image claims, beside the bytes that are there to hold it.
struct PixelClaim {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t bytes_per_pixel = 2;
  std::uint64_t stored_bytes = 0;  ///< of the file, the record or the stream that holds the pixels
};

/// Throws DataError, before any memory is taken, when the claim is no thermal image: no pixel, more than 100
/// million, or more than any codec could pack into the bytes. `what` names the file and the part of it.
void checkClaim(const PixelClaim& claim, const std::string& what);

}  // namespace thermovox
