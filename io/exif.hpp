#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace thermovox {

/// The texts of a picture's own directory of Exif tags; empty where it has none.
struct ExifFacts {
  std::string make, model, software, time;
};

/// Reads the TIFF structure that an Exif segment holds behind its name. What is damaged is left out.
[[nodiscard]] ExifFacts exifFacts(std::span<const std::byte> tiff);

}  // namespace thermovox
