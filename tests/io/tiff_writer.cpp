#include "tests/io/tiff_writer.hpp"

#include <tiffio.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace thermovox::test {
namespace {

void require(bool done) {
  if (!done) throw std::runtime_error("libtiff cannot write the test's image");
}

template <typename Pixel>
void writeTiles(TIFF* tiff, const TiffPages<Pixel>& pages, const std::vector<Pixel>& page, int edge) {
  for (int y = 0; y < pages.height; y += edge) {
    for (int x = 0; x < pages.width; x += edge) {
      std::vector<Pixel> tile(static_cast<std::size_t>(edge * edge));
      for (int row = 0; row < std::min(edge, pages.height - y); ++row) {
        for (int column = 0; column < std::min(edge, pages.width - x); ++column) {
          tile[row * edge + column] = page[(y + row) * pages.width + x + column];
        }
      }
      require(TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                            0, 0) > 0);
    }
  }
}

template <typename Pixel>
void writePage(TIFF* tiff, const TiffPages<Pixel>& pages, std::vector<Pixel> page, const TiffForm& form) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, pages.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, pages.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * sizeof(Pixel));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
               std::is_floating_point_v<Pixel> ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, form.compression);
  if (form.predictor != 1) TIFFSetField(tiff, TIFFTAG_PREDICTOR, form.predictor);
  if (form.photometric) TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  if (form.tile > 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, form.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, form.tile);
    writeTiles(tiff, pages, page, form.tile);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, form.rows_per_strip);
    for (int row = 0; row < pages.height; ++row) {
      require(TIFFWriteScanline(tiff, page.data() + row * pages.width, static_cast<std::uint32_t>(row)) == 1);
    }
  }
  require(TIFFWriteDirectory(tiff) == 1);
}

template <typename Pixel>
void write(const std::filesystem::path& file, const TiffPages<Pixel>& pages, const TiffForm& form) {
  const std::string mode = std::string("w") + (form.big_endian ? "b" : "l") + (form.big_tiff ? "8" : "");
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(file.c_str(), mode.c_str()), TIFFClose);
  require(tiff != nullptr);
  for (const std::vector<Pixel>& page : pages.pages) writePage(tiff.get(), pages, page, form);
}

}  // namespace

void writeTiff(const std::filesystem::path& file, const TiffPages<std::uint16_t>& pages,
               const TiffForm& form) {
  write(file, pages, form);
}

void writeTiff(const std::filesystem::path& file, const TiffPages<float>& pages, const TiffForm& form) {
  write(file, pages, form);
}

void writeTiff(const std::filesystem::path& file, const TiffPages<std::uint8_t>& pages,
               const TiffForm& form) {
  write(file, pages, form);
}

}  // namespace thermovox::test
