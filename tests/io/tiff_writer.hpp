#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace thermovox::test {

/// How a TIFF for a test is laid out; the defaults are what a thermal camera writes.
struct TiffForm {
  int rows_per_strip = 6;
  int tile = 0;             ///< edge of square tiles; 0 for strips
  int compression = 1;      ///< libtiff's number: 1 none, 5 LZW, 8 deflate
  int predictor = 1;        ///< 2 horizontal differences, 3 floating point
  bool photometric = true;  ///< write the Photometric tag
  bool big_endian = false;
  bool big_tiff = false;
};

/// Pages of one size, row by row.
template <typename Pixel>
struct TiffPages {
  int width = 0;
  int height = 0;
  std::vector<std::vector<Pixel>> pages;
};

/// Write with libtiff's own encoder. Pixels of 16 bits without sign, 32-bit floats, or 8 bits (a picture).
void writeTiff(const std::filesystem::path& file, const TiffPages<std::uint16_t>& pages,
               const TiffForm& form = {});
void writeTiff(const std::filesystem::path& file, const TiffPages<float>& pages, const TiffForm& form = {});
void writeTiff(const std::filesystem::path& file, const TiffPages<std::uint8_t>& pages,
               const TiffForm& form = {});

}  // namespace thermovox::test
